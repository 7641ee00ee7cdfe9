"""One set of runs, and one folder with the reproduction, for all tests of the paper."""

import contextlib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from unittest.mock import patch

import pytest

from stickslip.extensions.paper.cases import Runs
from stickslip.extensions.paper.claims import CLAIMS, ClaimVerdict
from stickslip.extensions.paper.make import make
from tests.docs.pages import PAPER, run_page
from tests.limits import all_tests
from tests.pictures import blank


@pytest.fixture(scope="package")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[int, ClaimVerdict]]:
    """The folder that the command on the page about the paper writes, and its verdicts; the other examples of the page run, too.

    Pictures are left blank: `test_figures_of_paper.py` draws them, and with the slow tests those of the page are drawn, too.
    """
    home, steps, found = tmp_path_factory.mktemp("page"), list[str](), dict[int, ClaimVerdict]()

    def kept(number: int, measure: Callable[[Runs], ClaimVerdict], runs: Runs) -> ClaimVerdict:
        return found.setdefault(number, measure(runs))

    def make_deep(out: Path, tell: Callable[[str], None]) -> Path:
        made = make(out.with_name("deep") / "folder", lambda step: (steps.append(step), tell(step)))
        made.parent.rename(out)
        return out / made.name

    claims = {number: partial(kept, number, measure) for number, measure in CLAIMS.items()}
    with (
        contextlib.chdir(home),
        patch("stickslip.extensions.paper.make.make", make_deep),
        patch.dict(CLAIMS, claims),
        blank(*["png"] * all_tests()),
    ):
        run_page(PAPER, whole=True)
    assert len(steps) == 9 + 23 + 2
    return home / "paper", found


@pytest.fixture(scope="package")
def verdicts(made: tuple[Path, dict[int, ClaimVerdict]]) -> dict[int, ClaimVerdict]:
    return made[1]


@pytest.fixture(scope="package")
def folder(made: tuple[Path, dict[int, ClaimVerdict]]) -> Path:
    return made[0]
