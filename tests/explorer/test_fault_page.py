"""The page of a fault in 2D: what it shows is the run, and a slider asks for the run of its number."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.explorer.page.explorer import Explorer
from stickslip.explorer.page.fault import FaultPage, FaultSetting, solve_fault
from stickslip.scenarios import Scenario
from tests.explorer.desk_at_once import DeskAtOnce

SCENARIO = ss.scenarios["planar-patch"].with_values({"contact.nodes": 32, "run.duration": 0.5})


def test_the_page_shows_the_run_and_its_sliders_ask_for_others() -> None:
    answer, asked = solve_fault(SCENARIO, lambda text: None), list[Scenario]()
    run = answer.run

    def solve(scenario: Scenario, told: Any) -> Any:
        asked.append(scenario)
        _ = scenario.planar_slab
        return answer

    setting: Any = FaultSetting(SCENARIO)
    explorer = Explorer(setting, DeskAtOnce(), solve)
    page = FaultPage(explorer)
    explorer.change(setting)
    assert asked == [SCENARIO]
    assert np.array_equal(np.nan_to_num(page.image.data["image"][0]), run.slip_rate.T.astype(np.float32))
    assert np.array_equal(page.middle.data["slip"], run.slip[:, 16])
    assert run.sentences[0] in page.words.object

    sliders = {one.label: one for one in page.view[1][0]}
    assert {"friction.static", "patches[0].initial.load (MPa)", "patches[1].y[0] (km)", "nodes"} <= set(sliders)
    assert not [name for name in sliders if name.startswith(("loading.", "body.driver", "initial.slip"))], "0 and inf have none"
    assert sliders["patches[0].initial.load (MPa)"].start < 71.0 < sliders["patches[0].initial.load (MPa)"].end

    page._enter("contact.patches[0].initial.load", 1e6, SimpleNamespace(new=75.0))
    page._enter("contact.nodes", 1.0, SimpleNamespace(new=40.9))
    assert asked[-1].contact is not None
    assert (asked[-1].contact.nodes, dict(asked[-1].contact.patches[0].values)) == (40, {"initial.load": 75e6})
    page._enter("contact.courant", 1.0, SimpleNamespace(new=3.0))
    assert "courant must be at most" in page.words.object
    assert run.sentences[0] in page.words.object
    page._enter("contact.courant", 1.0, SimpleNamespace(new=0.5))
    assert 'class="fault"' not in page.words.object
