"""A slow and simple reference integrator: scipy's DOP853 from one breaking point to the next, with its dense output as history.

It shares no code with the engine or with the analysis of the contact. It supports perfect delay only, keeps every piece of the
history in memory, and evaluates the load through all earlier round trips. It is therefore suited to seconds or minutes of sliding,
not to years.
Source of the equations: Campillo et al. 1996, eqs (4)-(6) for the block, (12)-(13) for the slab.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from stickslip.foundation.errors import InputError
from stickslip.friction import HyperbolicRate
from stickslip.friction.formula.at_points import AtPoints
from stickslip.friction.formula.differences import changes, points_of, tape_of_changes
from stickslip.friction.formula.expression import Expression
from stickslip.problem.loading import LoadingHistory
from stickslip.problem.problem import Problem

Load = Callable[[float, float], float]
"""Load minus initial strength (Pa or N) as a function of time (s) and of slip since the start (m)."""
FIRST = np.zeros(1, np.int64)
"""The formula and the member of points that have one of each."""
_MAX_PIECES = 20_000
"""Number of pieces beyond which events are taken to accumulate at a point in time."""


@dataclass(frozen=True)
class Piece:
    """The motion between two times (s): slip since the start (m), slip rate (m/s), and load minus initial strength (Pa or N)."""

    start: float
    end: float
    slip: Callable[[float], float]
    rate: Callable[[float], float]
    load: Callable[[float], float]


@dataclass(frozen=True)
class StepsSolution:
    """A run by the method of steps: its motion between breaking points in order of time; values at a joint are right limits."""

    problem: Problem
    pieces: list[Piece]

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the absolute slip u(t) (m) at times t (s), of the shape of t."""
        return self.problem.initial_slip + self._values("slip", t)

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip rate v(t) (m/s) at times t (s), of the shape of t."""
        return self._values("rate", t)

    def load(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the load at times t (s), of the shape of t: beta(t) (Pa) of a slab, or the spring force (N) of a block."""
        return self.problem.strength + self._values("load", t)

    def _values(self, name: str, t: ArrayLike) -> NDArray[np.float64]:
        times = np.asarray(t, float)
        starts = np.array([piece.start for piece in self.pieces])
        index = np.clip(np.searchsorted(starts, times.ravel(), side="right") - 1, 0, None)
        values = [getattr(self.pieces[i], name)(x) for i, x in zip(index.tolist(), times.ravel().tolist(), strict=True)]
        return np.array(values, float).reshape(times.shape)


def method_of_steps(problem: Problem, duration: float, rtol: float = 1e-10) -> StepsSolution:
    """Integrate a problem with the selection rule "perfect-delay" from one breaking point to the next, over a duration (s).

    Raises InputError for another rule, for a law with kinks in slip rate, and for a law of slip rate on a contact without mass that
    is neither eq. (15) nor Coulomb's; RuntimeError if events accumulate at a point in time.
    """
    if problem.selection != "perfect-delay":
        raise InputError(f"method_of_steps: knows perfect-delay only, got '{problem.selection}'")
    return _Stepper(problem, rtol).run(float(duration))


@dataclass
class _Stepper:
    """The state of an integration: the pieces so far, and the piece of the law in use.

    `walked` in its methods is the slip (m) that the law has counted since the start, or since the last arrest for a law that heals;
    `sense` is the direction of slip, 1 or -1, and 0 for stick.
    """

    problem: Problem
    rtol: float
    pieces: list[Piece] = field(default_factory=list)

    def __post_init__(self) -> None:
        body, law = self.problem.body, self.problem.friction
        self.mass = body.inertia
        self.normal, self.strength = self.problem.normal, self.problem.strength
        self.knots = law.knots
        self.pieces_of_law = [self._points(tree, law.numbers(i)) for i, tree in enumerate(law.trees())]
        self.hyperbolic = self.mass == 0.0 and law.kind == "hyperbolic-rate"
        if self.mass == 0.0 and law.depends_on_rate and law.kind not in ("hyperbolic-rate", "coulomb"):
            raise InputError(f"method_of_steps: cannot solve {type(law).__name__} on a contact without mass")
        self.path, self.heals = law.counts == "path", law.memory == "since-arrest"
        if len(law.pieces) > 1 and law.knot_variable == "rate":
            raise InputError(f"method_of_steps: cannot follow kinks in slip rate, which {type(law).__name__} has")
        start = self.problem.law_slip
        self.home = self.part = int(law.piece_at(start))
        here = float(law.coefficient(start))
        self.offsets = [float(law.piece_coefficient(i, start, 0.0)) - here for i in range(len(law.pieces))]
        self.offsets[self.part] = 0.0

    # ---- friction and forces, as differences from the initial strength --------------------------------------------------------

    def friction(self, walked: float, rate: float) -> float:
        """Return S [mu(law slip, rate) - mu(law slip at the start, 0)] (Pa or N)."""
        step, _ = changes(self.pieces_of_law[self.part], FIRST, walked, np.array([rate]))
        return self.normal * (float(step[0]) + self.offsets[self.part])

    def _points(self, tree: Expression, numbers: Mapping[str, float]) -> AtPoints:
        """Return what follows a piece of the law from its initial slip, as `difference` does: made once, not in each call."""
        tape = tape_of_changes((tree,), tuple(numbers))
        return points_of(tape, FIRST, np.array([[*numbers.values(), self.problem.law_slip]]))

    def pull(self, sense: int, load: float) -> float:
        """Return the load in the direction of slip, minus the initial static strength (Pa or N)."""
        return load if sense > 0 else -2.0 * self.strength - load

    def drive(self, sense: int, load: float, walked: float, rate: float) -> float:
        """Return the load minus sliding friction (Pa or N), in the direction of slip."""
        return self.pull(sense, load) + self.normal * self.problem.friction.static_excess - self.friction(walked, rate)

    def beyond(self, sense: int, load: float, walked: float) -> float:
        """Return the excess of the load over the static strength (Pa or N), in the direction of slip."""
        return self.pull(sense, load) - self.friction(walked, 0.0)

    def room(self, sense: int, load: float, walked: float) -> float:
        """Return a number that is positive as long as a massless contact can continue to slip."""
        if self.hyperbolic:
            return _fast_room(self.problem, self.pull(sense, load))
        return self.drive(sense, load, walked, 0.0)

    def massless_rate(self, sense: int, load: float, walked: float) -> float:
        if self.hyperbolic:
            return _fast_rate(self.problem, self.pull(sense, load))
        return max(self.drive(sense, load, walked, 0.0), 0.0) / self.problem.body.damping

    # ---- the load ---------------------------------------------------------------------------------------------------------------

    def load_near(self, time: float) -> Load:
        """Return the load minus initial strength as a function of time and slip, between the breaking points around `time`."""
        p, body, start = self.problem, self.problem.body, self.problem.excess
        if not body.has_waves:
            pulled = _pulled(p.pull_rate, time)
            return lambda t, slip: start + body.stiffness * (pulled(t) - slip)
        ramp, trip = body.stiffness * p.first_pull_rate, body.round_trip_time
        if time < 0.5 * trip:
            return lambda t, slip: start + ramp * t
        r, delay = body.reflection, 0.5 * trip
        rate, far = _near(p.pull_rate, time - delay), _near(p.load if p.far_stress is None else p.far_stress, time - delay)
        share = 2.0 * body.impedance * (1.0 if body.is_driven_rigidly else 0.5 * (1.0 - r))
        source = next((piece for piece in self.pieces if piece.start <= time - trip < piece.end), None)

        def load(t: float, slip: float) -> float:
            x = t - trip
            outgoing = 2.0 * body.impedance * source.rate(x) - source.load(x) if source else -ramp * x - start
            sent = t - delay
            return r * outgoing + share * rate(sent) + (1.0 + r) * (far(sent) + p.far_stress_rate * sent - self.strength)

        return load

    # ---- time -------------------------------------------------------------------------------------------------------------------

    def run(self, duration: float) -> StepsSolution:
        body = self.problem.body
        trip = body.round_trip_time if body.has_waves else math.inf
        breaks = {0.5 * trip, trip, *self._breaks_of_loading()}
        t, state, sense = 0.0, np.zeros(3), self._sense_at_start()
        while t < duration:
            if len(self.pieces) > _MAX_PIECES:
                raise RuntimeError(f"method_of_steps: events pile up at {t:g} s")
            breaks = {b for b in breaks if b > t + 1e-13 * max(t, 1e-3)}
            stop = min([duration, *breaks])
            load = self.load_near(0.5 * (t + stop))
            if sense == 0 and self.heals:
                state[1], self.part = 0.0, self.home
                sense = next((s for s in (1, -1) if self.beyond(s, load(t, float(state[0])), 0.0) > 0.0), 0)
            end, state, after = self._rest(t, stop, state, load) if sense == 0 else self._slide(t, stop, state, load, sense)
            breaks |= {end + trip}  # its echo
            t, sense = (
                end,
                self._sense(end, min([duration, *(b for b in breaks if b > end)]), state, sense) if after is None else after,
            )
        return StepsSolution(self.problem, self.pieces)

    def _breaks_of_loading(self) -> set[float]:
        histories = [h for h in (self.problem.pull_rate, self.problem.far_stress) if isinstance(h, LoadingHistory)]
        body = self.problem.body
        delay = 0.5 * body.round_trip_time if body.has_waves else 0.0
        return {segment.start + delay for history in histories for segment in history.segments}

    def _sense_at_start(self) -> int:
        excess = self.problem.excess
        if excess == 0.0:
            return 1 if self.problem.first_pull_rate > 0.0 else 0
        return next((s for s in (1, -1) if self.beyond(s, excess, 0.0) > 0.0), 0)

    def _sense(self, t: float, stop: float, state: NDArray[np.float64], before: int) -> int:
        """Return the direction of slip (0: stick) on the interval that begins at t."""
        slip, walked, rate = (float(x) for x in state)
        if self.mass > 0.0 and rate != 0.0:
            return int(math.copysign(1, rate))
        load = self.load_near(0.5 * (t + max(stop, t)))(t, slip)
        if self.mass == 0.0 and before != 0 and self.room(before, load, walked) > 0.0:
            return before
        return next((s for s in (1, -1) if self.beyond(s, load, walked) > 0.0), 0)

    def _rest(self, t: float, stop: float, state: NDArray[np.float64], load: Load) -> tuple[float, NDArray[np.float64], int | None]:
        """Stay stuck until the load reaches the strength, or until the next breaking point.

        Returns the end of the rest (s), the state there, and the direction of the slip that begins (None: to be determined).
        """
        slip, walked, _ = (float(x) for x in state)
        end, after = stop, None
        for sense in (1, -1):

            def over(x: float, sense: int = sense) -> float:
                return self.beyond(sense, load(x, slip), walked)

            grid = np.linspace(t, end, 400)
            above = np.array([over(x) for x in grid.tolist()]) > 0.0
            onset = np.flatnonzero(above[1:] & ~above[:-1])
            if above[0] and above[1]:
                end, after = t, sense
            elif onset.size:
                end, after = float(brentq(over, grid[onset[0]], grid[onset[0] + 1], xtol=1e-14, rtol=1e-15)), sense
        self._keep(Piece(t, end, lambda x: slip, lambda x: 0.0, lambda x: load(x, slip)))
        return end, np.array([slip, walked, 0.0]), after

    def _slide(
        self, t: float, stop: float, state: NDArray[np.float64], load: Load, sense: int
    ) -> tuple[float, NDArray[np.float64], int | None]:
        """Slip in one direction until the contact stops, the law reaches a knot, or the next breaking point.

        Returns the end of the slip (s), the state there, and the direction of the motion that follows (None: to be determined).
        """
        motion = self._with_mass(load, sense) if self.mass > 0.0 else self._without_mass(load, sense)
        events = [motion[1]]
        ahead = self.part if self.path or sense > 0 else self.part - 1
        if 0 <= ahead < len(self.knots):
            events.append(_terminal(lambda x, y: y[1] - (self.knots[ahead] - self.problem.law_slip), 0.0))
        # without a limit, the first steps from rest under an oscillating load would be too long for the error estimate to notice
        longest = (stop - t) / 50.0 if self.problem.varies else math.inf
        accuracy = {"rtol": self.rtol, "atol": 1e-22, "max_step": longest}
        run = solve_ivp(motion[0], (t, stop), state, method="DOP853", events=events, dense_output=True, **accuracy)
        end, dense, part = float(run.t[-1]), run.sol, self.part

        def rate(x: float) -> float:
            slip, walked, speed = dense(x)
            here, self.part = self.part, part
            value = float(speed) if self.mass > 0.0 else sense * self.massless_rate(sense, load(x, slip), walked)
            self.part = here
            return value

        self._keep(Piece(t, end, lambda x: float(dense(x)[0]), rate, lambda x: load(x, float(dense(x)[0]))))
        final = np.array(run.y[:, -1])
        if run.status == 1 and run.t_events[0].size:
            final[2] = 0.0
            return end, final, None if self.mass > 0.0 else 0
        if run.status == 1:
            self.part += 1 if ahead == self.part else -1
            return end, final, sense
        return end, final, None

    def _without_mass(self, load: Load, sense: int) -> tuple[Any, Any]:
        def velocity(t: float, y: NDArray[np.float64]) -> list[float]:
            speed = self.massless_rate(sense, load(t, y[0]), y[1])
            return [sense * speed, speed if self.path else sense * speed, 0.0]

        return velocity, _terminal(lambda t, y: self.room(sense, load(t, y[0]), y[1]), -1.0)

    def _with_mass(self, load: Load, sense: int) -> tuple[Any, Any]:
        def velocity(t: float, y: NDArray[np.float64]) -> list[float]:
            speed = sense * y[2]
            force = self.drive(sense, load(t, y[0]), y[1], max(speed, 0.0)) - self.problem.body.damping * speed
            return [y[2], speed if self.path else y[2], sense * force / self.mass]

        return velocity, _terminal(lambda t, y: sense * y[2], -1.0)

    def _keep(self, piece: Piece) -> None:
        if piece.end > piece.start:
            self.pieces.append(piece)


def _coefficients(problem: Problem, excess: float) -> tuple[float, float, float]:
    """Return alpha Z, minus the linear coefficient, and the discriminant of the quadratic for the slip rate under law (15).

    Let e be the load minus S muS, and drop = S (muS - muD). Then Z v - drop alpha v / (1 + alpha v) = e is equivalent to
    alpha Z v^2 + (Z - alpha drop - alpha e) v - e = 0.
    """
    law, body = problem.friction, problem.body
    assert isinstance(law, HyperbolicRate)
    square = law.alpha * body.damping
    linear = law.alpha * problem.normal * (law.static - law.dynamic) - body.damping + law.alpha * excess
    return square, linear, linear**2 + 4.0 * square * excess


def _fast_rate(problem: Problem, excess: float) -> float:
    """Return the stable (larger) root (m/s) at an excess (Pa), or the rate of the fold if there is no root, but not below 0."""
    square, linear, discriminant = _coefficients(problem, excess)
    root = math.sqrt(max(discriminant, 0.0))
    if linear <= 0.0:
        return max(2.0 * excess, 0.0) / (root - linear) if root > linear else 0.0
    return 0.5 * (linear + root) / square


def _fast_room(problem: Problem, excess: float) -> float:
    """Return a number that is positive while a positive stable root exists, and passes 0 where it ends: at the fold or excess 0."""
    _, linear, discriminant = _coefficients(problem, excess)
    return discriminant if linear > 0.0 else excess


def _near(history: float | LoadingHistory, time: float) -> Callable[[float], float]:
    """Return a pull rate or far stress as a function of time that is valid on the segment around a time (s)."""
    if not isinstance(history, LoadingHistory):
        return lambda t: history
    segment, tone = [s for s in history.segments if s.start <= max(time, 0.0)][-1], history.tone
    return lambda t: segment.at(t) + tone.amplitude * math.sin(tone.frequency * t + tone.phase)


def _pulled(history: float | LoadingHistory, time: float) -> Callable[[float], float]:
    """Return the displacement (m) of a driver since 0 s as a function of time that is valid on the segment around a time (s)."""
    if not isinstance(history, LoadingHistory):
        return lambda t: history * t
    past, tone = [s for s in history.segments if s.start <= max(time, 0.0)], history.tone
    ends, now = [s.start for s in past[1:]], past[-1]
    before = math.fsum((end - s.start) * s.at(0.5 * (s.start + end)) for s, end in zip(past, ends, strict=False))

    def pulled(t: float) -> float:
        swung = tone.amplitude / tone.frequency * (math.cos(tone.phase) - math.cos(tone.frequency * t + tone.phase))
        return before + (t - now.start) * now.at(0.5 * (now.start + t)) + swung

    return pulled


def _terminal(event: Callable[[float, NDArray[np.float64]], float], direction: float) -> Any:
    """Mark a function as an event that ends scipy's integration."""
    marked: Any = event
    marked.terminal, marked.direction = True, direction
    return marked
