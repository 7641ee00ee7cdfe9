"""Statistics of small catalogues, worked out by hand."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.cli.output.summary import statistics
from stickslip.figures.runs import catalogue
from tests.problems import SLAB, rate_law_slab

TABLE = pd.DataFrame(
    {
        "end": [1.0, 3.0, 7.0, 8.0, np.nan],
        "recurrence": [np.nan, 2.0, 4.0, 1.0, 5.0],
        "slip": [1.0, 2.0, 3.0, 2.0, 100.0],
    }
)


def test_statistics_agree_with_those_worked_out_by_hand() -> None:
    found = ss.studies.catalogue_statistics(TABLE)
    assert list(found.index) == ["recurrence", "slip"]
    recurrence, slip = found.loc["recurrence"], found.loc["slip"]
    assert (recurrence["count"], recurrence["mean"], recurrence["median"]) == (4, 3.0, 3.0)
    deviation = np.sqrt((1.0 + 1.0 + 4.0 + 4.0) / 3.0)
    assert recurrence["deviation"] == pytest.approx(deviation, rel=1e-15, abs=0.0)
    assert recurrence["variation"] == pytest.approx(deviation / 3.0, rel=1e-15, abs=0.0)
    assert (slip["count"], slip["mean"], slip["smallest"], slip["largest"]) == (4, 2.0, 1.0, 3.0)  # not the one cut off
    # 2, 4, 1 against 4, 1, 5: covariances -13/3 over (14/3 * 26/3)^(1/2), means 7/3 and 10/3
    assert recurrence["next"] == pytest.approx(-19.0 / np.sqrt(14.0 * 26.0), rel=1e-12, abs=0.0)


def test_summary_and_figure_leave_out_the_event_that_the_end_of_the_run_cuts_off() -> None:
    whole = ss.simulate("direct-shear-block").events
    run = ss.simulate("direct-shear-block", float(whole.start.iloc[-1] + 0.3 * whole.duration.iloc[-1]))
    events = run.events
    assert np.isnan(events.end.iloc[-1])
    assert events.slip.iloc[-1] < 0.5 * events.slip.iloc[0]
    (line,) = statistics(dict(events.items()))
    recurrence, slip, note = line.replace("; ", ", without ").split(", without ")
    assert slip.startswith("slip: mean 0.0034")
    assert float(re.findall(r"deviation (\S+) %", slip)[0]) < 1e-6, "all whole events are alike"
    assert (recurrence[:10], note) == ("recurrence", "the event that the end of the run cuts off\n")
    np.testing.assert_array_equal(catalogue.catalogue_shown(run).whole_slip, events.slip[:-1])
    assert "without" not in statistics(dict(whole.items()))[0]


def test_equal_values_follow_each_other_without_correlation() -> None:
    found = ss.studies.catalogue_statistics(ss.simulate("cycles-block").events)
    assert found.variation["recurrence"] < 1e-9
    assert found.variation["slip"] < 1e-9
    assert np.isnan(found.next["recurrence"])


def test_too_few_events_give_missing_values() -> None:
    one = ss.studies.catalogue_statistics(ss.simulate(rate_law_slab(), 12.0).events)
    assert one.loc["recurrence", "count"] == 0
    assert one.loc["slip", "mean"] == pytest.approx(23.4402332474, rel=1e-10, abs=0.0)
    assert np.isnan(one.loc["slip", "deviation"])
    none = ss.studies.catalogue_statistics(
        ss.simulate(ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), initial_load=1e6), 10.0).events
    )
    assert (none["count"] == 0).all()
    assert none["mean"].isna().all()


def test_energies_are_described_where_the_table_has_them() -> None:
    run = ss.simulate("cycles-block")
    found = ss.studies.catalogue_statistics(run.catalogue(energy=True))
    assert found.loc["released", "variation"] < 1e-9
