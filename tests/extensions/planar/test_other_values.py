"""A scenario with other values, along a contact of many nodes."""

from __future__ import annotations

import stickslip as ss


def test_pressing_changes_all_loads_along_a_contact_too() -> None:
    scenario = ss.scenarios["planar-patch"].with_values({"pressing": "50 MPa"})
    before, after = ss.scenarios["planar-patch"].to_solve, scenario.to_solve
    assert (after.values.normal == 0.5 * before.values.normal).all()
    assert (after.values.load == 0.5 * before.values.load).all()
    assert len(set(after.values.load)) > 1
