"""What a finished run of a uniform body with waves says, from the one wave that left its contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, Positions, Side
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem, wave_before
from stickslip.problem.bodies import as_waves
from stickslip.solution.observables.asked import AtContact, AtDriver, Extent, Field, FollowedFronts, LoadCompared, ObservablesOfKind
from stickslip.solution.observables.driver_of_waves import driver_behind
from stickslip.solution.observables.energy.balance import epochs, heat
from stickslip.solution.observables.energy.ground import shaken, shaking, speed
from stickslip.solution.observables.field import rounding, slab_of, velocity_and_stress
from stickslip.solution.observables.given_load import of_ground
from stickslip.solution.observables.inside_slab import field_of_slab, kinetic
from stickslip.solution.observables.proof import Places
from stickslip.solution.observables.proof_of_load import compared_in_steps, times_in
from stickslip.solution.observables.quadrature import between
from stickslip.solution.observables.waves import Radiation, Waves

MOST_TRIPS = 1000
"""Over more round trips than this, the ways of one and the same front cannot be told apart."""


class ObservablesOfUniform(ObservablesOfKind):
    """The answers of uniform bodies with waves; energies are in J/m^2."""

    def energies(self, history: History, at: Positions, nodes: int) -> dict[str, Floats]:
        """Return them from the waves inside, the way of the contact mass, and what the driver and moving ground have done."""
        body = as_waves(history.problem.body)
        waves, radiation, now = Waves(history, body), Radiation(history, body), epochs(history, at)
        contact = 0.5 * body.inertia * speed(history, at) ** 2
        each = np.array([(waves.stored(epoch), waves.trapped(epoch), kinetic(waves, epoch)) for epoch in now]).reshape(-1, 3)
        each[:, 2] += [waves.driver.kinetic(waves.begun(epoch)) for epoch in now]
        stored, trapped, moving = each[:, 0] + contact, each[:, 1], each[:, 2] + contact
        return {
            "work": np.array([waves.work(epoch) for epoch in now]) + shaken(history, at),
            "stored": stored,
            "elastic": stored - moving,
            "kinetic": moving,
            "heat": heat(history, at),
            "damped": np.zeros(len(now)),
            "radiated": np.array([radiation.work(epoch) for epoch in now]),
            "trapped": trapped,
        }

    def event_energies(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return them from the waves at the start and at the end of each event, and from the work in between."""
        body = as_waves(history.problem.body)
        waves = Waves(history, body)
        spans = list(zip(epochs(history, first), epochs(history, last), strict=True))
        moving = 0.5 * body.inertia * (speed(history, first) ** 2 - speed(history, last) ** 2)
        work = np.array([waves.work_between(begin, end) for begin, end in spans])
        if history.problem.ground is not None:
            work += between(history, first, last, shaking(history))
        return {
            "released": np.array([waves.stored(begin) - waves.stored(end) for begin, end in spans]) + moving,
            "work": work,
            "damped": np.zeros(len(spans)),
            "trapped": np.array([waves.trapped(end) for _, end in spans]),
        }

    def energetics(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return them from the waves, without the kinetic energy of a driver."""
        body = as_waves(history.problem.body)
        waves, radiation = Waves(history, body), Radiation(history, body)
        begin, end = epochs(history, first), epochs(history, last)
        before, after = (np.array([kinetic(waves, epoch) for epoch in moments]) for moments in (begin, end))
        contact = 0.5 * body.inertia * (speed(history, last) ** 2 - speed(history, first) ** 2)
        return {
            "kinetic": after - before + contact,
            "radiated": np.array([radiation.work_between(*span) for span in zip(begin, end, strict=True)]),
            "trapped_before": np.array([waves.trapped(epoch) for epoch in begin]),
        }

    def trapped(self, history: History) -> float:
        """Return the energy of the waves that are on their way at the end."""
        end = epochs(history, Positions.inside(len(history) - 1, 1.0))[0]
        return Waves(history, as_waves(history.problem.body)).trapped(end)

    def at_driver(self, history: History, time: Floats, side: Side) -> AtDriver:
        """Return them from the wave that left the contact h/c ago, and from the one that the driver sends back."""
        begin, end = history.span
        history.find(time, side)  # raises InputError
        waves = Waves(history, as_waves(history.problem.body))
        slack = rounding(time, history.round_trip_time) * (1.0 if side == "left" else -1.0)
        left = time - waves.half  # when the wave that meets the driver left the contact
        in_run = left - slack >= begin if side == "right" else left - slack > begin
        leaving = waves.left_before(np.minimum(left - begin, 0.0))
        if in_run.any():
            leaving[in_run] = waves.leaving(history.find(np.clip(left - slack, begin, end)[in_run], side))
        sent_back = waves.arriving(leaving, left - begin, slack)
        return AtDriver(*velocity_and_stress(leaving, sent_back, waves.body.impedance, waves.reference))

    def field(self, history: History, at_contact: AtContact, place: Floats, time: Floats, side: Side) -> Field:
        """Return it from both waves at each place."""
        return field_of_slab(history, at_contact, place, time, side)

    def extent(self, problem: Problem) -> Extent:
        """Return the places from the contact to the driver."""
        slab = slab_of(problem)
        return Extent(0.0, slab.distance, (), slab.two_way_time)

    def fronts(self, problem: Problem) -> FollowedFronts:
        """Return the largest share that the driver, or one to which it changes, sends back of a front."""
        body = slab_of(problem)
        most = max((share for _, share in problem.driver_steps[1:]), key=abs, default=0.0)
        return FollowedFronts(body.two_way_time, max(most, body.front_reflection, key=abs), MOST_TRIPS)

    def load_compared(self, history: History) -> LoadCompared:
        """Compare the loads with what the waves bring, in steps and beside breaks of the loading."""
        return compared_in_steps(history, _of_waves)


def _of_waves(history: History, piece: Places, xi: Floats) -> Floats:
    """Return the load of a uniform body minus the reference strength (Pa): the echo, what the driver sends, and moving ground."""
    problem, body = history.problem, as_waves(history.problem.body)
    trip, phase, time, inside = times_in(history, piece, xi)
    leaving = np.empty(len(piece))
    first = trip == 0
    slope = body.impedance * problem.initial_shear / (0.5 * history.round_trip_time)
    leaving[first] = slope * (history.round_trip_time - phase[first]) - wave_before(problem)
    leaving[~first] = _left(history, piece[~first], trip[~first], phase[~first], inside[~first])
    load = driver_behind(problem).a_slab(history, body).load_at(leaving, time, inside)
    load = np.where(first & (inside < 0.5 * history.round_trip_time), problem.excess + slope * phase, load)
    velocity, acceleration = of_ground(problem, time, inside)
    return np.asarray(load - body.impedance * velocity - body.inertia * acceleration)


def _left(history: History, piece: Places, trip: NDArray[np.int64], phase: Floats, inside: Floats) -> Floats:
    """Return the wave 2 Z v - load, plus the reference (Pa), that left the contact one round trip before places in pieces."""
    problem, store = history.problem, history.store
    if not len(piece):
        return np.empty(0)
    before = np.searchsorted(store.trip, trip, side="left") - 1
    source = history.phases.latest(phase, before)
    known = source >= 0
    source = np.where(known, source, 0)
    echoed = history.xi(source, np.maximum(phase - store.phase_from[source], 0.0))
    rests = (trip - 1 - store.trip[source]).astype(float)
    at = Positions(source, echoed, rests, np.zeros(len(piece), bool), source)
    velocity, acceleration = of_ground(problem, (trip - 1) * history.round_trip_time + phase, inside - history.round_trip_time)
    left = 2.0 * problem.body.impedance * history.rate(at) - history.excess(at)
    left += problem.body.impedance * velocity - problem.body.inertia * acceleration
    return np.where(known, left, np.nan)


ANSWERS = ObservablesOfUniform()
