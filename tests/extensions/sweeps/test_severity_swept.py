"""A sweep keeps the severity of stick-slip."""

from __future__ import annotations

import stickslip as ss


def test_it_is_that_of_the_run() -> None:
    run = ss.simulate("drill-string", "60 s")
    found = ss.sweep("drill-string", {"pull_rate": ["60 rpm"]}, quantities=["severity"])
    assert found.severity.values.item() == ss.studies.severity(run)
    assert found.severity.attrs["units"] == "1"
