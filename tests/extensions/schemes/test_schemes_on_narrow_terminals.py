"""The table of schemes on narrow terminals: no line is too long, and no number is broken."""

from __future__ import annotations

import pytest

from stickslip.extensions.schemes.schemes import schemes
from stickslip.extensions.schemes.summary import show_schemes
from stickslip.problem.scenarios.scenario import load_scenario
from tests.core.cli.narrow import check_fits


@pytest.mark.parametrize("width", [60, 40])
def test_the_table_of_schemes_fits(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int):
    scenario = load_scenario("fig4-loop")
    study = schemes(scenario, scheme=["lag", "central-differences-cfl1"], cells=[20, 40])
    show_schemes(scenario, study)
    wide = capsys.readouterr().out
    monkeypatch.setenv("COLUMNS", str(width))
    show_schemes(scenario, study)
    check_fits(capsys.readouterr().out, wide, width)
