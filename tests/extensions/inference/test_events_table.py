"""Tables of slip events, fitted by their features: closed forms of a block under Coulomb friction make the tables."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.record.features import about_falls
from tests.command_line import Command
from tests.extensions.inference.laboratory import CoulombBlock
from tests.messages import refused

BLOCK = CoulombBlock()
GUESS = ss.Problem(
    ss.SpringBlock(BLOCK.mass, 3.2e6, 1e3), ss.friction.Coulomb(BLOCK.static, 0.46), pull_rate=BLOCK.pull, initial_load=300.0
)
FREE = ("friction.dynamic", "body.stiffness")
TRUTH = {"friction.dynamic": BLOCK.dynamic, "body.stiffness": BLOCK.stiffness}
SCENARIO = """
[body]
kind = "spring-block"
mass = 2
stiffness = 3.2e6
normal_force = 1000
[friction]
kind = "coulomb"
static = 0.65
dynamic = 0.46
[loading]
pull_rate = 1e-3
[initial]
load = 300
[run]
duration = 1
"""
SLIDES = math.pi * math.sqrt(BLOCK.mass / BLOCK.stiffness)


def events(seed: int, count: int = 40, scatter: float = 0.01) -> dict[str, Any]:
    """Return a table of events whose static friction scatters: spring forces (N), times (s) and slips (mm), without the engine.

    A block without losses comes to rest as far beyond balance as it began, after half a period of its spring.
    """
    peak = BLOCK.normal * BLOCK.static * (1.0 + scatter * np.random.default_rng(seed).standard_normal(count))
    rest = 2.0 * BLOCK.normal * BLOCK.dynamic - peak
    before = np.append(2.0 * BLOCK.normal * BLOCK.dynamic - BLOCK.normal * BLOCK.static, rest[:-1])
    recurrence = (peak - before) / (BLOCK.stiffness * BLOCK.pull) + SLIDES
    slip = (peak - rest) / BLOCK.stiffness + BLOCK.pull * SLIDES
    return {"peak": peak, "rest": rest, "recurrence": recurrence, "slip": 1e3 * slip}


def forces(seed: int) -> dict[str, Any]:
    table = events(seed)
    names = ("Peak force (N)", "Min force (N)", "Recurrence time (s)", "slip (mm)")
    return dict(zip(names, table.values(), strict=True))


def fit(data: Any, **options: Any) -> Any:
    return ss.studies.infer(GUESS, data, FREE, **({"sensor": "spring", "by": "features", "starts": 1} | options))


def distances(found: Any) -> list[float]:
    """Return how far the numbers found are from the true ones, in standard errors."""
    return [abs(found.table.loc[name].value - truth) / found.table.loc[name].uncertainty for name, truth in TRUTH.items()]


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("seed", range(3))
def test_numbers_behind_a_table_of_events_are_found_within_their_errors(seed: int) -> None:
    found = fit(forces(seed))
    assert max(distances(found)) < 3.5
    assert (found.table.uncertainty / found.table.value < 0.03).all()  # 1 % of scatter, 40 events: small, and not without bounds


@pytest.mark.slow
def test_a_table_without_scatter_gives_the_numbers_to_a_thousandth() -> None:
    table = events(0, scatter=1e-9)
    found = fit(dict(zip(forces(0), table.values(), strict=True)))
    for name, truth in TRUTH.items():
        assert found.table.loc[name].value == pytest.approx(truth, rel=1e-3)


@pytest.mark.slow
def test_drops_and_times_say_the_same_as_levels_and_recurrences() -> None:
    table = events(4)
    whole = {
        "time": np.cumsum(table["recurrence"]),
        "max force (N)": table["peak"],
        "force drop (N)": table["peak"] - table["rest"],
    }
    record = ss.studies.Record.read(whole)
    assert list(record.measured) == ["shear_force_peak", "shear_force_rest", "shear_force_drop", "recurrence"]
    np.testing.assert_allclose(record.measured["shear_force_rest"], table["rest"], rtol=1e-12)
    np.testing.assert_allclose(record.measured["recurrence"][1:], table["recurrence"][1:], rtol=1e-9)
    assert math.isnan(record.measured["recurrence"][0])
    assert max(distances(fit(whole))) < 3.5


def test_friction_needs_no_normal_force_and_cells_may_be_missing() -> None:
    table = events(5)
    peak, rest = (np.array(table[name]) / BLOCK.normal for name in ("peak", "rest"))
    peak[::3] = math.nan
    rest[1::3] = math.nan
    found = fit({"static friction": peak, "friction after": rest, "recurrence (ms)": 1e3 * table["recurrence"]})
    assert max(distances(found)) < 3.5
    assert "friction_peak has no number in 14 of 40 events" in found.notes


@pytest.mark.slow
def test_a_printed_table_is_read_with_its_title_and_units(command: Command, tmp_path: Path) -> None:
    path, table = tmp_path / "table2.csv", events(6)
    rows = [f"{i};{a:.2f};{b:.2f};{c:.6f};{d:.5f};" for i, (a, b, c, d) in enumerate(zip(*table.values(), strict=True))]
    head = "Table 2: rig 4, 12 runs; all events\n\nEvent;Peak force;Min force;Recurrence;Slip;remark\n;N;N;s;mm;\n"
    path.write_text(head + "\n".join(rows).replace(".", ",") + "\n")
    record = ss.studies.Record.read(path)
    np.testing.assert_allclose(record.measured["event_slip"], table["slip"] / 1e3, rtol=0.0, atol=0.6e-8)
    assert any("shear_force_peak (column 2) is in N, as the row of units in line 4 says" in note for note in record.notes)
    scenario = tmp_path / "mine.toml"
    scenario.write_text(SCENARIO)
    options = ["--free", "dynamic,stiffness", "--by", "features", "--sensor", "spring", "--starts", "1"]
    told = command("infer", str(scenario), str(path), *options, "--out", str(tmp_path / "found.nc"))
    assert told.code == 0, told.err
    assert "4 features of 40 slip events" in " ".join(told.out.split())
    named = ["--column", "shear_force_peak=Peak force", "--column", "recurrence=4", "--observe", "rest,recurrence"]
    told = command("infer", str(scenario), str(path), *options, *named, "--figure", str(tmp_path / "found.png"))
    assert told.code == 0, told.err
    assert "2 features of 40 slip events" in " ".join(told.out.split())


FAULTS = [
    ({"peak force (N)": [1, 2, 3], "slip (mm)": [1, 1, 1]}, "needs a column recurrence (time from event to event) or time"),
    ({"peak force (N)": [1, 2, 3], "friction drop": [1, 1, 1], "time (s)": [0, 1, 2]}, "they are one measurement"),
    ({"peak force (N)": [1, 2, 3], "rest force (N)": [4, 4, 4], "time (s)": [0, 1, 2]}, "named the wrong way round?"),
    ({"peak force (N)": [1, -2, 3], "time (s)": [0, 1, 2]}, "shear_force_peak must be above 0, got -2 in event 2"),
    ({"peak stress (MPa)": [1, 1, 1, 2], "time (s)": [0, 1, 2, 3]}, "the loads of a block are in N, and shear_stress in Pa"),
    (
        {"peak (N)": [1, 2], "rest (N)": [0, 1], "recurrence (s)": [1, 1]},
        "such as peak force (N), and is fitted with --by features",
    ),
    ({"peak force (N)": [1, 2, 3], "time (s)": [0, 1, 2]}, "3 whole slip events are too few for the scatter of 2 features"),
]


@pytest.mark.parametrize(("table", "message"), FAULTS)
def test_a_table_that_says_too_little_is_told_what_it_lacks(table: Any, message: str) -> None:
    with refused(message):
        fit(table)


def test_samples_are_not_fitted_to_a_table_of_events() -> None:
    with refused("is a table of slip events, and no record of samples: fit it with by='features'"):
        fit(forces(0), by="samples")
    with refused("is a table of slip events, which allows no held_out"):
        fit(forces(0), held_out=0.3)


def test_a_record_of_too_few_events_says_how_they_were_found() -> None:
    time = np.arange(0.0, 0.4, 1e-4)
    force, _ = BLOCK.sampled(time, 300.0)
    falls = np.count_nonzero(np.diff(force) < -20.0)
    assert falls > 0
    with refused("whole slip events are too few", "an event is a fall of more than", "0.25 of the usual fall", "parts='rests'"):
        fit({"time (s)": time, "shear force (N)": force})
    told = about_falls(np.tile(np.append(np.linspace(0.0, 1.0, 50), 0.9 - np.linspace(0.0, 0.8, 5)), 4), "N")
    assert "more than 0.257 N" in told  # a quarter of all but 2 % of a range of 1.04, without the trend
    assert "3 of 3 falls above the noise are as large" in told
