"""Try one mutant in a child process: no copy of the tree, no compilation that the change does not ask for, tests before hashes.

The parent imports what is expensive and forks. Where only the body of a Python function changed, the child exchanges the code of
the function that is already there. Otherwise the child imports the package with the changed text in place of the file; functions
of the engine that depend on the change are compiled without the cache on disk, all others come from it.
"""

from __future__ import annotations

import ast
import functools
import gc
import importlib
import importlib.machinery
import json
import os
import pkgutil
import resource
import sys
import tempfile
import time
import types
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from benchmarks.mutants import SOURCE, Mutant
from benchmarks.mutation_reach import depends_on_no_cache, must_compile

TREE = Path(__file__).resolve().parent.parent
QUIET = ("-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-W", "ignore::pytest.PytestAssertRewriteWarning")
"""Options of pytest; the warning is about plugins that were imported before the process forked."""
COMPILATION = 300.0
"""Seconds that the first test of a mutant may take longer."""


class Chosen:
    """A pytest plugin: run the items of `rank` (node id to usual seconds) in its order, and note the first failure.

    A test that needs far more processor time than usual is killed with the process (`note` tells the parent which one it was).
    No further test begins once `seconds` of processor time are used up.
    """

    def __init__(self, rank: dict[str, float], seconds: float, note: Callable[[str], None]) -> None:
        self.rank, self.failed, self.passed = rank, "", 0
        self.end, self.note, self.unfinished = time.process_time() + seconds, note, False

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Run the items."""
        order = {test: n for n, test in enumerate(self.rank)}
        items = sorted((item for item in session.items if item.nodeid in order), key=lambda item: order[item.nodeid])
        for item, following in zip(items, [*items[1:], None], strict=False):
            used = time.process_time()
            self.unfinished = used > self.end
            if self.failed or self.unfinished:
                break
            self.note(item.nodeid)
            allowed = used + 20.0 + 10.0 * self.rank[item.nodeid] + (COMPILATION if self.passed == 0 else 0.0)
            resource.setrlimit(resource.RLIMIT_CPU, (int(allowed) + 1, resource.RLIM_INFINITY))
            item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        resource.setrlimit(resource.RLIMIT_CPU, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        return True

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note what failed first."""
        if report.failed and not self.failed:
            self.failed = report.nodeid
        self.passed += report.when == "call" and report.passed

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """A module that cannot be imported is a failure, too."""
        if report.failed and not self.failed:
            self.failed = report.nodeid


class Collected:
    """A pytest plugin: do something else in place of the tests, when they have been collected."""

    def __init__(self, work: Callable[[], None]) -> None:
        self.work = work

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Do it; children find the session's tests."""
        _sessions.append(session)
        self.work()
        return True


_sessions: list[pytest.Session] = []
"""The tests that this process has collected before it forks, if it has."""


def run_tests(rank: dict[str, float], seconds: float, note: Callable[[str], None]) -> dict[str, Any]:
    """Run the tests up to the first failure: its node id ("" if there is none), how many passed, and if time ran out."""
    plugin, status = Chosen(rank, seconds, note), 0
    if _sessions:
        _sessions[0].config.pluginmanager.register(plugin)
        plugin.pytest_runtestloop(_sessions[0])
        _sessions[0].config.pluginmanager.unregister(plugin)
    elif rank:
        places = sorted({test.split("::")[0] for test in rank})
        status = int(pytest.main(["-x", *QUIET, *places], plugins=[plugin]))
    failed = plugin.failed or ("" if status in (0, 5) else f"pytest ended with {status}")
    return {"failed": failed, "passed": plugin.passed, "unfinished": plugin.unfinished}


def make_hot(places: Sequence[str], work: Callable[[], None]) -> None:
    """Import the package and the tests, and load the engine's machine code; then do the work, which forks children."""
    import stickslip

    for module in pkgutil.walk_packages(stickslip.__path__, "stickslip."):
        if not module.name.endswith("__main__"):
            importlib.import_module(module.name)
    pytest.main(["-s", *QUIET, *places], plugins=[Collected(work)])


def in_child(work: Callable[[Callable[[str], None]], dict[str, Any]]) -> dict[str, Any]:
    """Return what the work returns in a forked child; {"died": signal, "during": its last note} if the child is killed."""
    with tempfile.NamedTemporaryFile("r", suffix=".json") as answer:
        child = os.fork()
        if child == 0:
            _work_and_leave(work, Path(answer.name))
        _, status = os.waitpid(child, 0)
        text = answer.read()
    if os.WIFSIGNALED(status) or not text.startswith("{"):
        return {"died": os.WTERMSIG(status), "during": text}
    found: dict[str, Any] = json.loads(text)
    return found


def _work_and_leave(work: Callable[[Callable[[str], None]], dict[str, Any]], answer: Path) -> None:
    try:
        result = quietly(lambda: work(lambda text: (answer.write_text(text), None)[1]))
    except BaseException as error:
        result = {"broken": f"{type(error).__name__}: {str(error)[:100]}"}
    answer.write_text(json.dumps(result))
    os._exit(0)


def quietly(work: Callable[[], Any]) -> Any:
    """Do the work with both outputs closed."""
    sys.stdout.flush()
    kept = os.dup(1), os.dup(2)
    nothing = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nothing, 1)
    os.dup2(nothing, 2)
    try:
        return work()
    finally:
        sys.stdout.flush()
        os.dup2(kept[0], 1)
        os.dup2(kept[1], 2)


def function_around(text: bytes, mutant: Mutant) -> str | None:
    """Qualified name of the outermost function whose body holds the change; None if it lies elsewhere."""
    line = text[: mutant.begin].count(b"\n") + 1

    def within(body: list[ast.stmt], prefix: str) -> str | None:
        for node in body:
            if isinstance(node, ast.FunctionDef) and node.body[0].lineno <= line <= (node.end_lineno or 0):
                return prefix + node.name
            if isinstance(node, ast.ClassDef) and node.lineno <= line <= (node.end_lineno or 0):
                return within(node.body, f"{prefix}{node.name}.")
        return None

    return within(ast.parse(text).body, "")


def exchange(mutant: Mutant) -> bool:
    """Put the changed code into the function that is loaded already; False if that is not possible."""
    path = TREE / SOURCE / mutant.path
    name = function_around(path.read_bytes(), mutant)
    if name is None:
        return False
    changed = _code_named(compile(mutant.applied(path.read_bytes()), str(path), "exec", dont_inherit=True), name)
    found = 0
    for thing in gc.get_objects():
        if isinstance(thing, types.FunctionType):
            code = thing.__code__
            if code.co_qualname == name and code.co_filename == str(path):
                new = [one for one in changed if one.co_firstlineno == code.co_firstlineno]
                if len(new) != 1 or new[0].co_freevars != code.co_freevars:
                    return False
                thing.__code__ = new[0]
                found += 1
    forget()
    return found > 0


def _code_named(code: types.CodeType, name: str) -> list[types.CodeType]:
    inner = [one for one in code.co_consts if isinstance(one, types.CodeType)]
    return [one for one in inner if one.co_qualname == name] + [found for one in inner for found in _code_named(one, name)]


def forget() -> None:
    """Clear what the package has remembered of earlier calls."""
    for thing in gc.get_objects():
        if isinstance(thing, functools._lru_cache_wrapper) and str(thing.__module__).startswith("stickslip"):
            thing.cache_clear()


def import_changed(mutant: Mutant) -> None:
    """Let the coming import of the package find the changed text, and compile anew what depends on it."""
    path = TREE / SOURCE / mutant.path
    text = mutant.applied(path.read_bytes())
    original = importlib.machinery.SourceFileLoader.get_code

    def get_code(self: Any, fullname: str) -> Any:
        if self.get_filename(fullname) == str(path):
            return compile(text, str(path), "exec", dont_inherit=True)
        return original(self, fullname)

    importlib.machinery.SourceFileLoader.get_code = get_code  # type: ignore[method-assign]
    if depends_on_no_cache(mutant.path):
        os.environ["STICKSLIP_CACHE_DIR"] = tempfile.mkdtemp(prefix="mutant-")
    if must_compile(TREE, mutant):  # all that is called from Python; the machine code of formulas comes from the disk
        from numba.core.caching import NullCache

        from stickslip.engine.codegen import one_module

        one_module.SealedCache = lambda function: NullCache()  # type: ignore[assignment, misc]


def runs() -> Any:
    """Solutions of the fixed suite, for changes that have no part in them."""
    from benchmarks import mutation_check

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return mutation_check.runs()


def hashes(known: Any = None) -> dict[str, str]:
    """Hashes of the fixed suite, in this process; of solutions that are known, if there are."""
    from benchmarks import mutation_check

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return mutation_check.measured(known or mutation_check.runs())
