"""Disturbances with their echoes along runs of slabs and strings: beside differences of runs, long runs, and edges of branches."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.section import onsets
from stickslip.extensions.cycles.waves.image import Image
from stickslip.extensions.cycles.waves.mesh import WaveSource, mesh_of
from stickslip.extensions.cycles.waves.section import WaveReturn, WaveSection, place_in
from stickslip.extensions.cycles.waves.slopes_of_return import grown_columns, is_known

F = ss.friction
SOON = "bristles, and slip backwards"
"""A problem whose disturbances fade in a period; of others a return is the second meeting with the section."""
NUDGE = 2e-6
"""Size of disturbances (1, share of the extent) by which differences are taken."""


@cache
def drill_string() -> ss.Problem:
    return ss.load_scenario("drill-string").problem


def string(pull: float, share: float = 4.0, **changed: Any) -> ss.Problem:
    """Return the bundled drill string behind a drive whose impedance is so many times its own, at a pull rate (rad/s)."""
    problem = drill_string()
    body = replace(problem.body, driver_impedance=share * problem.body.impedance)
    return replace(problem, body=body, pull_rate=pull, **changed)


def slab(law: ss.friction.FrictionLaw, mass: float = 1e6, **start: Any) -> ss.Problem:
    body = ss.ElasticSlab(2800, 3500, 1000, 1e8, contact_mass=mass, driver_impedance=1e8)
    return ss.Problem(body, law, pull_rate=0.02, initial_load=6.2e7, **start)


AGEING: dict[str, Any] = {"reference": 0.6, "a": 0.01, "b": 0.015, "distance": 0.01, "rate": 1e-6}
RUNS: dict[str, tuple[Any, float]] = {
    "a Stribeck law with rest": (lambda: string(8.7), 50.0),
    "a law that drops where slip begins": (lambda: string(3.0, 20.0, friction=F.Coulomb(0.8, 0.1)), 30.0),
    "a law of points": (lambda: string(7.0, friction=F.PiecewiseLinearRate([0, 1, 5, 30], [0.8, 0.6, 0.5, 0.45])), 50.0),
    "friction that lags, and rest": (
        lambda: string(8.0, friction=F.LaggedFriction(F.ExponentialStribeck(0.8, 0.5, 1.1), 0.05), initial_state=0.0),
        60.0,
    ),
    SOON: (
        lambda: string(7.0, friction=F.LuGre(static=0.8, dynamic=0.3, rate=1.1, stiffness=100.0, damping=0.5), initial_state=0.0),
        50.0,
    ),
    "rate and state": (lambda: slab(F.RateAndState(**AGEING), initial_rate=0.024, initial_state="steady"), 25.0),
    "rate and state without a mass": (lambda: slab(F.RateAndState(**AGEING), 0.0, initial_state=0.5), 12.0),
    "two states": (
        lambda: slab(
            F.TwoStateRateAndState(0.6, 0.01, 0.015, 0.01, second_b=0.002, second_distance=0.03),
            initial_rate=0.024, initial_state="steady", initial_second_state="steady",
        ),
        25.0,
    ),
}  # fmt: skip
"""Problems, and how long (s) they are run."""


def last_return(problem: ss.Problem, lasts: float, meetings: int) -> tuple[WaveSection, WaveReturn]:
    """Return the section of a problem, and a return from its last meeting in a run; it need not be near a cycle."""
    history = ss.simulate(problem, lasts, 1e-12).history
    half = history.slipped(history.find(np.array([0.5, 1.0]) * lasts, "left"))
    mean = float(half[1] - half[0]) / (0.5 * lasts)
    section = WaveSection(problem, len(onsets(history).time) > 2, 1e-12, mean / problem.first_pull_rate)
    met = section.met(history)
    source, period = WaveSource(history, float(met.time[-1])), float(met.time[-1] - met.time[-1 - meetings])
    place = place_in(history, met, len(met.time) - 1, mesh_of(source, source.kinks(period), 1e-6))
    return section, section.returned(place, period)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", RUNS)
def test_what_a_return_makes_of_disturbances_is_what_differences_of_runs_say(name: str) -> None:
    """Two waves and each state, to 5e-6 of the largest number, for runs with events, without, and with echoes of either.

    The waves are 0 where the wave begins, since a load that an onset meets too late or too early is no start of one.
    """
    problem, lasts = RUNS[name]
    section, met = last_return(problem(), lasts, 1 if name == SOON else 2)
    assert is_known(met)
    image = Image(met.start, met.time)
    states, phases = len(met.start.states), met.start.mesh.phases / met.begin
    ways = np.zeros((len(image.start), 2 + states))
    ways[states:, 0], ways[states:, 1] = np.sin(0.5 * np.pi * phases), np.sin(2.5 * np.pi * phases)
    ways[:states, 2:] = np.eye(states)
    found = grown_columns(met, ways * image.scale[:, None]) / image.scale[:, None]
    for n, way in enumerate(ways.T):
        ends = [image.of(image.start + sign * NUDGE * way, section)[0] for sign in (1.0, -1.0)]
        by_runs = (ends[0] - ends[1]) / (2.0 * NUDGE)
        assert np.abs(by_runs).max() > 1e-4
        assert found[:, n] == pytest.approx(by_runs, rel=0.0, abs=5e-6 * max(1.0, np.abs(by_runs).max()))
