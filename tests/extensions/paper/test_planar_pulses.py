"""The chapter on several pulses in 2D and 3D: its laws, its stored study, and what it says about it."""

from __future__ import annotations

import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.paper.cases import problem
from stickslip.extensions.paper.planar import (
    ANSWER,
    LARGE,
    Fault,
    curve_in_2d,
    middle_rate,
    peaks,
    process_zone,
    pulses_of,
    pulsing,
    stored,
    table,
    weakening,
)
from tests.extensions.planar.planar_methods import FrictionalVolume, LawAtNodes, PlanarCase

TRIP = 40.0 / 7.0
PAGE = Path(__file__).parents[3] / "docs" / "pulses-in-2d-and-3d.md"


def test_the_paper_belongs_to_the_family_of_slip_laws() -> None:
    found, paper = pulsing(), problem("fig5-slab-reconstructed")
    assert found.parameters["wavenumber"].value == pytest.approx(50.0, rel=1e-12, abs=0.0)
    assert found.load == pytest.approx(paper.load, rel=1e-12, abs=0.0)
    assert found.initial_slip == pytest.approx(paper.initial_slip, abs=1e-7)
    assert process_zone(found) == pytest.approx(9 * np.pi / 16 * 3.43e10 / 2.5e9, rel=1e-4, abs=0.0)


@pytest.mark.parametrize("excess", [0.01, LARGE, 0.3])
def test_all_slip_laws_have_their_pulses_in_1d_at_the_times_of_the_papers(excess: float) -> None:
    """0.154, 2.2567 and 4.3594 s, then arrest at 2h/c: to 1 ms."""
    run = ss.simulate(pulsing(excess), 2.0 * TRIP)
    times = np.linspace(0.0, TRIP, 40_001)[1:-1]
    assert peaks(times, run.slip_rate(times)) == pytest.approx([0.153986, 2.256706, 4.359426], abs=1e-3)
    assert run.events.pulses.tolist() == [3]
    assert run.events.end.tolist() == pytest.approx([TRIP], rel=1e-12, abs=0.0)


def test_slip_weakening_falls_as_steeply_from_the_same_load() -> None:
    assert process_zone(weakening(LARGE)) == pytest.approx(process_zone(pulsing(LARGE)), rel=1e-6, abs=0.0)
    assert weakening(LARGE).load == pulsing(LARGE).load
    assert weakening(LARGE).strength == pytest.approx(1.5e8, rel=1e-12, abs=0.0)


def test_before_the_echo_the_middle_has_the_pulses_of_1d_until_the_ends_are_heard() -> None:
    """In all stored rows; grids agree in the number of pulses, and under slip laws in their times to 0.03 s."""
    times = defaultdict(list)
    for row in stored():
        assert row["pulses before echo"] == row["pulses in 1D until ends arrive"], row
        found = np.array(row["peaks [s]"].split(), float)
        if row["law"] == "slip":
            times[row["excess"], row["shape"], row["L/h"]].append(found[found < TRIP])
    assert len(times) > 15
    for several in times.values():
        assert np.ptp(np.array(several), axis=0).max() < 0.03


def test_after_the_echo_the_middle_of_long_faults_slips_again() -> None:
    """In every stored run over two round trips or more with L >= 2 h: one to four pulses until 4h/c."""
    counts = {"2D": [], "3D": []}
    for row in stored():
        if float(row["round trips"]) >= 2.0 and float(row["L/h"]) >= 2.0 and row["replicas"] == "alone":
            found = np.array(row["peaks [s]"].split(), float)
            counts["2D" if row["shape"] == "line" else "3D"].append(int(np.sum((found > TRIP) & (found < 2.0 * TRIP))))
    assert all(1 <= count <= 4 for several in counts.values() for count in several)
    assert min(len(several) for several in counts.values()) >= 1
    assert "one to four pulses" in ANSWER[2]


@pytest.mark.slow
def test_a_stored_row_is_what_the_run_gives() -> None:
    """L = h in 2D: the same pulses, at the same times to 0.02 s."""
    fault = Fault(pulsing(LARGE), 1.0)
    run = ss.simulate(fault.slab, 2.0 * TRIP, frames=500)
    row = next(row for row in stored() if (row["law"], row["excess"], row["L/h"], row["nodes"]) == ("slip", "0.1", "1", "106"))
    wanted = np.array(row["peaks [s]"].split(), float)
    rate = middle_rate(run)
    assert peaks(run.times, rate) == pytest.approx(wanted[wanted < 2.0 * TRIP], abs=0.02)
    assert pulses_of(rate) == np.sum(wanted < 2.0 * TRIP)


@pytest.mark.slow
def test_the_volume_method_sees_the_pulses_after_the_echo_too() -> None:
    """L = 2 h in 2D, on the grid of the run and on its own in the slab: five pulses, at the stored times to 0.03 s."""
    fault = Fault(pulsing(LARGE), 2.0)
    large, _ = fault.slab.alone_for(2.0 * TRIP)
    body, values, middle = large.body, large.values, large.shape[0] // 2
    friction = LawAtNodes(fault.problem.friction, values.normal, values.law_slip)
    case = PlanarCase(body.density, body.wave_speed, body.thickness, large.extent, values.load, friction, locked=large.locked)
    run, rates = FrictionalVolume(case, 340, 2.0 * TRIP), []
    while run.time < 2.0 * TRIP:
        run.advance()
        rates.append((run.time - 0.5 * run.step_of_time, run.slip_rate[middle]))
    row = next(row for row in stored() if (row["law"], row["excess"], row["L/h"], row["nodes"]) == ("slip", "0.1", "2", "422"))
    wanted = np.array(row["peaks [s]"].split(), float)
    assert len(wanted[wanted < 2.0 * TRIP]) == 5
    assert peaks(*np.transpose(rates)) == pytest.approx(wanted[wanted < 2.0 * TRIP], abs=0.03)


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("nucleus", "wanted"), [(0.8, 1), (2.0, 2)])
def test_the_length_that_counts_is_that_over_which_slip_begins_at_once(nucleus: float, wanted: int) -> None:
    """A fault of 4 h in 2D, loaded by 1 % of the amplitude less than it bears: pulses before the echo in the middle of a nucleus.

    Where slip travels out of a nucleus of 0.8 h, there is one pulse at every node until 4h/c.
    """
    like, length, height = pulsing(LARGE), 4e4, 1e4
    wavenumber = like.parameters["wavenumber"].value
    count = 2 * round(0.625 * length * 8.0 / process_zone(like))
    contact = ss.PlanarSlab(
        ss.Problem(like.body, like.friction, initial_slip=0.5 * np.pi / wavenumber, initial_load=149.5e6),
        count,
        1.25 * length,
        along={"initial.load": lambda y: np.where(np.abs(y) < 0.5 * nucleus * height, 155e6, 149.5e6)},
        barrier=lambda y: np.abs(y) > 0.5 * length,
        replicas=False,
    )
    run = ss.simulate(contact, 2.0 * TRIP, frames=300)
    assert pulses_of(run.slip_rate[run.times < TRIP])[count // 2] == wanted
    if nucleus < 1.0:
        assert set(pulses_of(run.slip_rate)[np.abs(contact.y) < 1.7 * height]) == {1}


def test_without_the_library_the_chapter_shows_the_stored_run_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    now, origin = curve_in_2d()
    assert origin == "computed with this report"
    monkeypatch.setitem(sys.modules, "stickslip.extensions.planar.solver", None)
    kept, origin = curve_in_2d()
    assert "the library JAX is missing" in origin
    assert np.interp(now[0], *kept) == pytest.approx(now[1], abs=0.02 * now[1].max())


def test_the_page_shows_the_stored_study() -> None:
    text = PAGE.read_text(encoding="utf-8")
    for row in table():
        del row["commit"]  # it stands with the stored rows
        assert f"| {' | '.join(row.values())} |" in text


def test_peaks_are_the_maxima_that_count_as_pulses() -> None:
    times = np.linspace(0.0, 10.0, 2001)
    rate = sum(size * np.exp(-(((times - at) / 0.3) ** 2)) for at, size in ((2.0, 3.0), (5.0, 1.0), (8.0, 0.05)))
    rate += 0.02 * np.sin(40.0 * times) * (rate > 0.5)
    assert peaks(times, rate) == pytest.approx([2.0, 5.0], abs=0.1)
    assert pulses_of(rate) == 2
