"""One set of runs, and one folder with the reproduction, for all tests of the paper."""

import contextlib
from collections.abc import Callable
from pathlib import Path
from unittest.mock import patch

import pytest

from stickslip.paper import make
from stickslip.paper.cases import Runs
from stickslip.paper.claims import CLAIMS, ClaimVerdict
from tests.docs.pages import PAPER, run_page


@pytest.fixture(scope="package")
def verdicts() -> dict[int, ClaimVerdict]:
    runs = Runs()
    return {number: measure(runs) for number, measure in CLAIMS.items()}


@pytest.fixture(scope="package")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder that the command on the page about the paper writes. The page's other examples, which read it, are run, too."""
    home, steps = tmp_path_factory.mktemp("page"), list[str]()

    def make_deep(out: Path, tell: Callable[[str], None]) -> Path:
        made = make(out.with_name("deep") / "folder", lambda step: (steps.append(step), tell(step)))
        made.parent.rename(out)
        return out / made.name

    with contextlib.chdir(home), patch("stickslip.paper.make", make_deep):
        run_page(PAPER, whole=True)
    assert len(steps) == 8 + 20 + 2
    return home / "paper"
