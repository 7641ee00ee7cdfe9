"""Call the command as the shell does."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from stickslip.cli.main import main
from tests import compile_first


@dataclass(frozen=True)
class Outcome:
    code: int
    out: str
    err: str

    @property
    def refusal(self) -> str:
        """The one line with which a command was refused, without its beginning; a command that was not refused fails the test."""
        assert (self.code, self.out, self.err.count("\n")) == (2, "", 1), self
        assert self.err.startswith("stickslip: ")
        return self.err.removeprefix("stickslip: ")


@pytest.fixture(scope="session", autouse=True)
def compiled_engine() -> None:
    """Compile the engine and its parts before any test looks at what a command says on standard error; `make` has done so."""
    if "COMPILED_FIRST" not in os.environ:
        compile_first.main()


@pytest.fixture(autouse=True)
def _pictures(request: pytest.FixtureRequest) -> None:
    """Leave pictures blank, and what they would show coarse, but for tests that look at them or at what is said of them."""
    if request.node.get_closest_marker("drawn") is None:
        request.getfixturevalue("blank_pictures")
        request.getfixturevalue("coarse")


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Outcome]:
    """Run `stickslip` with arguments, in an empty folder."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> Outcome:
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        shown = capsys.readouterr()
        return Outcome(int(ended.value.code or 0), shown.out, shown.err)

    return run
