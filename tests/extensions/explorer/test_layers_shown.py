"""The explorer draws layers, and both sides of a contact."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.page.panels import field as field_panel
from stickslip.extensions.explorer.page.panels import shape as shape_panel
from stickslip.extensions.explorer.page.panels.units import units_of


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(
    ("name", "lowest", "boundaries"), [("low-velocity-zone", 0.0, (1000.0,)), ("steel-on-granite", -0.09, (0.0,))]
)
def test_the_explorer_draws_layers_and_sides(name: str, lowest: float, boundaries: tuple[float, ...]) -> None:
    answer = solve(ss.load_scenario(name))
    assert answer.slab is not None
    assert answer.slab.place[0] == pytest.approx(lowest, rel=1e-12)
    assert answer.slab.boundaries == pytest.approx(boundaries, rel=1e-12)
    assert set(answer.energy.parts) == {"elastic", "kinetic", "heat", "total"}
    parts = sum(answer.energy.parts[part] for part in ("elastic", "kinetic", "heat"))
    assert parts == pytest.approx(answer.energy.parts["total"], rel=1e-9)
    units = units_of(answer)
    drawn = field_panel.data_of(answer, units)
    assert len(drawn.columns["layers"]["place"]) == len(boundaries)
    assert drawn.limits["place"][0] == pytest.approx(lowest / units.place[1], rel=1e-12)
    shape = shape_panel.data_of(answer, units).facts["shape"]
    assert 0.0 < shape["bar"] <= 0.3 * shape["width"]  # the bar is no longer than the largest displacement
    assert shape["boundaries"] == pytest.approx([one / units.place[1] for one in boundaries], rel=1e-12)


@pytest.fixture(autouse=True)
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.figures.runs.inside.TIMES", 60)
    monkeypatch.setattr("stickslip.figures.runs.inside.CELLS", 20)
    monkeypatch.setattr("stickslip.figures.runs.kinds.layered.ANSWERS.coarser", 1)
