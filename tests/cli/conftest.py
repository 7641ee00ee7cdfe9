"""Call the command as the shell does."""

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


@pytest.fixture(scope="session", autouse=True)
def compiled_engine() -> None:
    """Compile the engine and its parts before any test looks at what a command says on standard error."""
    compile_first.main()


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
