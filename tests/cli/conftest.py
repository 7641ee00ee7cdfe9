"""Call the command as the shell does."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

import stickslip as ss
from stickslip.cli.main import main


@dataclass(frozen=True)
class Outcome:
    code: int
    out: str
    err: str


@pytest.fixture(scope="session", autouse=True)
def compiled_engine() -> None:
    """Compile the engine and its parts before any test looks at what a command says on standard error."""
    for name in ("fig6-slab", "rate-and-state-block"):
        repr(ss.simulate(name))  # with events and all else that a summary compiles
    ss.sweep("fig6-slab", {"friction.alpha": [0.5, 1.0]})


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
