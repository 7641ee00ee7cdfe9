"""The core stands without any of its extensions: a copy in which the folder of one is missing imports, answers and runs.

`make test` takes one extension, chosen by the files of the package, and a few of the core's tests; `make test-all` takes each of
them, and all quick tests of the core.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
import pytest

import stickslip as ss
from stickslip.extension import Extension, extensions

ROOT = Path(__file__).parents[1]
PACKAGE = Path(ss.__file__).parent
OWN = [one.name for one in extensions() if type(one).__module__.startswith("stickslip.extensions.")]
FEW = (
    "tests/core/cli/test_completion.py",
    "tests/core/problem/scenarios/test_run_by_name.py",
)
"""Tests of the core that each `make test` runs in a copy."""
ASKED = """
import contextlib, hashlib, importlib, io, json, sys
import numpy as np
import pytest
import stickslip as ss

names, commands = json.loads(sys.argv[1])
found = {"file": ss.__file__, "names": {}, "commands": {}}
for name in names:
    try:
        face, _, last = ("stickslip." + name).rpartition(".")
        found["names"][name] = repr(getattr(importlib.import_module(face), last))
    except AttributeError as error:
        found["names"][name] = str(error)

from stickslip.cli.main import main
for command in ("--help", *commands):
    out, err = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            main([command])
    except SystemExit as ended:
        found["commands"][command] = [ended.code, out.getvalue(), err.getvalue()]

store = ss.simulate("fig6-slab").history.store
arrays = {name: one for name, one in store._asdict().items() if isinstance(one, np.ndarray)}
found["run"] = {name: hashlib.sha256(one.tobytes()).hexdigest() for name, one in arrays.items()}
found["loaded"] = sorted({name.split(".")[2] for name in sys.modules if name.startswith("stickslip.extensions.")})
with open("answers.json", "w") as file:
    json.dump(found, file)
sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[2:]]) if sys.argv[2:] else 0)
"""
"""What a copy is asked; then it runs tests, in the same process, because to start one takes longer than most of them."""


class Added(NamedTuple):
    """What an extension, and those that need it, add: names as they stand after `ss.`, and commands."""

    names: list[str]
    commands: list[str]


def added_by(name: str) -> Added:
    """Return what goes with an extension."""
    gone: set[str] = set()
    while more := {one.name for one in extensions() if one.name == name or gone & set(one.needs)} - gone:
        gone |= more
    there: list[Extension] = [one for one in extensions() if one.name in gone]
    typed = (command.__name__.replace("_", "-") for one in there for group in one.commands().values() for command in group)
    return Added([name for one in there for name in one.public()], list(typed))


def chosen() -> str:
    """Return the extension whose turn it is: the names and sizes of all files of the package decide, and no date."""
    files = sorted((str(file.relative_to(PACKAGE)), file.stat().st_size) for file in PACKAGE.rglob("*.py"))
    return OWN[int(hashlib.sha256(repr(files).encode()).hexdigest(), 16) % len(OWN)]


@contextmanager
def without(name: str) -> Iterator[Path]:
    """A copy of package and tests without an extension and its tests, and without those of the product as a whole."""
    with TemporaryDirectory(prefix=f"without-{name}-") as folder:
        place = Path(folder)
        shutil.copytree(PACKAGE, place / "src/stickslip", ignore=_but(PACKAGE / "extensions", name))
        shutil.copytree(ROOT / "tests", place / "tests", ignore=_but(ROOT / "tests/extensions", name))
        shutil.copytree(ROOT / "benchmarks", place / "benchmarks")  # wrong engines and composed laws, for tests of the core
        shutil.copy(ROOT / "pyproject.toml", place)
        for file in (place / "tests").glob("test_*.py"):
            file.unlink()
        assert not (place / "src/stickslip/extensions" / name).exists()
        yield place


def _but(folder: Path, name: str) -> Any:
    """Return what `copytree` asks: leave out one folder. Bytecode goes with the source, whose time it names."""
    return lambda path, names: [one for one in names if Path(path) == folder and one == name]


def python(place: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python in a copy, whose package it finds before any other."""
    paths = [str(place / "src"), str(place), os.environ.get("PYTHONPATH", "")]
    settings = os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, paths)), "OPENBLAS_NUM_THREADS": "1"}
    for one in ("PYTEST_XDIST_WORKER", "PYTEST_CURRENT_TEST"):
        settings.pop(one, None)
    return subprocess.run([sys.executable, *arguments], cwd=place, env=settings, capture_output=True, text=True, check=False)


@cache
def of_the_whole() -> dict[str, str]:
    """Return hashes of what the run has with all extensions there."""
    store = ss.simulate("fig6-slab").history.store
    return {name: hashlib.sha256(one.tobytes()).hexdigest() for name, one in store._asdict().items() if isinstance(one, np.ndarray)}


def check(place: Path, name: str, *tests: str) -> None:
    """Fail unless a copy imports, says in one line what is missing, runs bit for bit as the whole does, and passes tests."""
    gone = added_by(name)
    done = python(place, "-c", ASKED, json.dumps(gone), *tests)
    assert done.returncode == 0, done.stdout[-8000:] + done.stderr[-8000:]
    assert " passed" in done.stdout or not tests
    check_answers(place, name, gone, json.loads((place / "answers.json").read_text(encoding="utf-8")))


def check_answers(place: Path, name: str, gone: Added, found: dict[str, Any]) -> None:
    assert Path(found["file"]).is_relative_to(place)
    assert name not in found["loaded"]
    for public, answer in found["names"].items():
        assert f"{public.rpartition('.')[2]} here: it belongs to the extension '" in answer, answer
        assert answer.endswith(("', which is not installed", f"needs the extension '{name}', which is not installed")), answer
        assert "\n" not in answer
    code, shown, _ = found["commands"].pop("--help")
    assert code == 0
    listed = {line.split()[0] for line in shown.splitlines() if line.startswith("  ") and line.split()}
    assert "check" in listed
    assert not listed & set(gone.commands)
    assert set(found["commands"]) == set(gone.commands)
    for command, (status, out, err) in found["commands"].items():
        assert (status, out, err.count("\n")) == (2, "", 1), err
        assert f"'{command}'" in err
        assert "there is no command" in err or f"needs the extension '{name}'" in err
    assert found["run"] == of_the_whole() != {}


def test_the_core_stands_without_the_extension_whose_turn_it_is() -> None:
    name = chosen()
    with without(name) as place:
        check(place, name, *FEW)


@pytest.mark.slow
@pytest.mark.parametrize("name", OWN)
def test_the_core_stands_and_passes_its_tests_without_an_extension(name: str) -> None:
    with without(name) as place:
        check(place, name, "tests/core")
