"""One set of runs for all tests of the paper."""

import pytest

from stickslip.paper.cases import Runs
from stickslip.paper.claims import CLAIMS, Verdict


@pytest.fixture(scope="package")
def verdicts() -> dict[int, Verdict]:
    runs = Runs()
    return {number: measure(runs) for number, measure in CLAIMS.items()}
