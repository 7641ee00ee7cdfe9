"""One set of runs, and one folder with the reproduction, for all tests of the paper."""

from pathlib import Path

import pytest

from stickslip.paper import make
from stickslip.paper.cases import Runs
from stickslip.paper.claims import CLAIMS, Verdict


@pytest.fixture(scope="package")
def verdicts() -> dict[int, Verdict]:
    runs = Runs()
    return {number: measure(runs) for number, measure in CLAIMS.items()}


@pytest.fixture(scope="package")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("paper") / "deep" / "folder"
    steps: list[str] = []
    assert make(out, steps.append) == out / "report.html"
    assert len(steps) == 8 + 20 + 2
    return out
