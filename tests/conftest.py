"""Names and samples of the cases of parametrised tests, no deadline for drawn ones, and no terminal's width for printed tables.

Fixtures that tests of several folders need are here, too: those of commands and of figures.
"""

from __future__ import annotations

import gc
import hashlib
import os
import signal
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Mapping
from pathlib import Path

import llvmlite.binding as llvm
import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import settings

import stickslip as ss
from tests.command_line import Outcome
from tests.pictures import blank
from tests.sampling import FIRST, drawn
from tests.spent import LONG, Clock, folder_of, table_of

LONGEST = 60
"""Characters of a name."""
CLOCK, SPENT, TESTS = Clock(), Counter[str](), Counter[str]()
"""What a process has spent since its last report; what all tests have spent by folder, and their number there."""

os.environ.pop("COLUMNS", None)  # test runners set it, and tables are as wide as it says
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as in jobs that a shell runs in the background
    signal.signal(signal.SIGINT, signal.default_int_handler)
settings.register_profile("stickslip", deadline=None)  # a slow machine is no failure
settings.load_profile("stickslip")

# JAX, which planar slabs need, compiles alike functions once for all tests, processes and sessions, and in half the time: functions
# that run for milliseconds need not be optimised. `tests/extensions/planar/test_planar_solver.py` compares the numbers of optimised
# code. Machine code is kept apart for each kind of processor. JAX reads these settings when it is imported, which is after this.
PROCESSOR = hashlib.sha256(f"{llvm.get_host_cpu_name()} {llvm.get_host_cpu_features().flatten()}".encode()).hexdigest()
os.environ |= {
    "JAX_COMPILATION_CACHE_DIR": str(Path(__file__).parents[1] / ".pytest_cache" / f"jax-{PROCESSOR[:8]}"),
    "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
    "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES": "-1",
    "JAX_DISABLE_MOST_OPTIMIZATIONS": "1",
}


def pytest_report_header(config: pytest.Config) -> list[str]:
    """Say which cases are drawn, and whether the machine code is that of the sources: if not, it is made in the tests."""
    from stickslip.foundation.code_key import SHIPPED
    from stickslip.foundation.kernels.code import NAME

    draw = config.getoption("--draw")
    up_to_date = (SHIPPED / NAME).is_dir()
    return [
        f"sampled cases: those of --draw={draw}",
        f"machine code: {NAME}" if up_to_date else "machine code: out of date; `python -m stickslip.engine.build` makes it",
    ]


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect tests without looking for garbage, which takes a fifth of that time and finds none.

    What was collected lives as long as the tests: it is left out of later searches, each of which would walk all of it.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(700, 10, 50)  # beside so few old objects Python would walk those of the tests every few seconds
        gc.enable()
        CLOCK.lap()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Let a draw of the cases of sampled tests be asked for by its seed."""
    about = "seed that draws the cases of sampled tests, as the week 2026-W48; by default the first ones are run"
    parser.addoption("--draw", default=FIRST, metavar="SEED", help=about)


@pytest.hookimpl(tryfirst=True)  # before slow tests are left out
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the cases of a test with `sampled(every=N)` as slow, but for those that the draw takes."""
    tests: dict[str, list[pytest.Item]] = {}
    for item in items:
        if item.get_closest_marker("sampled"):
            tests.setdefault(item.nodeid.partition("[")[0], []).append(item)
    for test, cases in tests.items():
        marker = cases[0].get_closest_marker("sampled")
        assert marker is not None
        run = drawn(test, len(cases), marker.kwargs["every"], config.getoption("--draw"))
        for number, item in enumerate(cases):
            if number not in run:
                item.add_marker(pytest.mark.slow)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Note in the report of each part of a test what it took of the processor, for the process that prints the table."""
    report = yield
    report.user_properties.append(("processor time", CLOCK.lap()))
    return report


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Add up what the tests take of the processor, by folder."""
    folder = folder_of(report.nodeid)
    SPENT[folder] += dict(report.user_properties).get("processor time", 0.0)
    TESTS[folder] += report.when == "call"


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Write the table of what the tests took of the processor."""
    if SPENT.total() > LONG:
        terminalreporter.section("processor time of the tests, by folder")
        for line in table_of(SPENT, TESTS):
            terminalreporter.line(line)


@pytest.fixture
def blank_pictures() -> Iterator[None]:
    """Let figures be written as empty pictures."""
    with blank():
        yield


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw a ninth of the cells of an image, and a quarter of the times of a figure of energies, in as much less time."""
    monkeypatch.setattr("stickslip.figures.runs.inside.TIMES", 300)
    monkeypatch.setattr("stickslip.figures.runs.inside.CELLS", 100)
    monkeypatch.setattr("stickslip.figures.runs.energy.TIMES", 200)


@pytest.fixture
def pictures(request: pytest.FixtureRequest) -> None:
    """Leave pictures blank, and what they would show coarse, but for tests that look at them or at what is said of them."""
    if request.node.get_closest_marker("drawn") is None:
        request.getfixturevalue("blank_pictures")
        request.getfixturevalue("coarse")


@pytest.fixture
def command(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    pictures: None,
) -> Callable[..., Outcome]:
    """Run `stickslip` with arguments as the shell does, in an empty folder."""
    from stickslip.cli.main import main

    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> Outcome:
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        shown = capsys.readouterr()
        return Outcome(int(ended.value.code or 0), shown.out, shown.err)

    return run


@pytest.fixture
def closed_figures() -> Iterator[None]:
    """Open no windows, and begin and end with all figures of pyplot closed."""
    mpl.use("Agg")
    from matplotlib import pyplot

    pyplot.close("all")  # tests of other folders may have left some
    yield
    pyplot.close("all")


def pytest_make_parametrize_id(val: object) -> str | None:
    """Name laws and bodies by their kind, and lists and tables by what is in them; leave numbers and short texts to pytest."""
    name = val if isinstance(val, str) and len(val) > LONGEST else _name(val)
    return None if name is None else name[:LONGEST].encode("unicode_escape").decode()


def _name(value: object) -> str | None:
    if isinstance(value, ss.friction.FrictionLaw | ss.ElasticSlab | ss.SpringBlock | ss.loading.LoadingHistory):
        return value.kind
    if isinstance(value, ss.Problem):
        return f"{value.body.kind} under {value.friction.kind}"
    if isinstance(value, Mapping):
        return ", ".join(f"{_part(key)}={_part(one)}" for key, one in value.items()) or "nothing"
    if isinstance(value, np.ndarray):
        value = value.ravel().tolist()
    if isinstance(value, list | tuple):
        return " ".join(map(_part, value)) or "nothing"
    return type(value).__name__ if isinstance(value, Exception) else None


def _part(value: object) -> str:
    """Name something within a list or table, never by its address in memory."""
    if value is None or isinstance(value, str | int | float):
        return str(value)
    return _name(value) or getattr(value, "__name__", type(value).__name__)
