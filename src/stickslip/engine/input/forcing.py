"""Inflow: what the driver adds to the load at the contact. For tables and observables; the engine has its own `varying_forcing`.

The load of a slab is beta(t) = r w(t - R) + F(t). The inflow is F(t) = 2 Z [Zd V + s] / (Z + Zd) at t - h/c, or 2 Z V(t - h/c)
for a rigid driver, less (1 + r) times the reference strength, because all loads are differences from it. In terms of r it is
Z (1 - r) V + (1 + r) (s - reference), with the r of the driver that the wave has met. The load of a block grows by K V(t) per
second, less the mass times the jerk of the ground. What moving ground adds to the load of a slab is in `shaking`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import RIGID
from stickslip.problem import SILENT, Ground, LoadingHistory, Problem, Segment, Tone
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers


@dataclass(frozen=True, eq=False)
class Inflow:
    """Straight segments, each with the time (s) of its arrival, plus a tone. Slab: Pa; block: N/s.

    A segment has a reflection coefficient of the driver, too, and a factor of the tone.
    """

    start: Floats
    value: Floats
    slope: Floats
    tone: Tone
    round_trip_time: float
    is_block: bool
    reflection: Floats  # 1; 0 of a block
    gain: Floats  # 1, but for a tone that passes through a driver that changes

    def at(self, time: Floats, seen: Floats | None = None) -> Floats:
        """Return F at times (s since the start of the run), in the segments that hold at the times `seen`, by default the same.

        At a jump it is the right limit.
        """
        n = self.segment(time if seen is None else seen)
        straight = self.value[n] + self.slope[n] * (time - self.start[n])
        return straight if self.tone is SILENT else np.asarray(straight + self.gain[n] * self._swing(time))

    def reflection_at(self, time: Floats) -> Floats:
        """Return the factor (1) of the echo that arrives at times (s since the start of the run); at a jump, the right limit."""
        return self.reflection[self.segment(time)]

    def total(self, low: Floats, high: Floats) -> Floats:
        """Return the integral of F between times (s)."""
        first, last, middle = self.segment(low), self.segment(high), 0.5 * (low + high)
        inside = (high - low) * (self.value[first] + self.slope[first] * (middle - self.start[first]))
        straight = np.where(first == last, inside, self._up_to(last, high) - self._up_to(first, low))
        if self.tone is SILENT:
            return straight
        swings = self._swung(low, high)
        if np.ptp(self.gain) == 0.0:
            return np.asarray(straight + self.gain[0] * swings)
        starts = self.start[1:]
        whole = np.append(0.0, np.cumsum(self.gain[:-1] * self._swung(self.start[:-1], starts)))
        begun, ended = (whole[n] + self.gain[n] * self._swung(self.start[n], t) for n, t in ((first, low), (last, high)))
        return np.asarray(straight + np.where(first == last, self.gain[first] * swings, ended - begun))

    def gathered(self, trip: Floats, offset: Floats, trips: Floats) -> Floats:
        """Return the growth of a load at rest over the given number of whole round trips, while only the tone changes.

        On a slab it is the sum of F over these round trips: their number times the mean of F, with Dirichlet's kernel for the tone.
        """
        time = trip * self.round_trip_time + offset
        if self.is_block:
            return self.total(time, time + trips * self.round_trip_time)
        n = self.segment((trip + 1.0) * self.round_trip_time)
        rigid = self.reflection[n] == RIGID
        if not rigid.any():
            return np.zeros(len(trips))
        middle = time + 0.5 * (trips + 1.0) * self.round_trip_time
        straight = trips * (self.value[n] + self.slope[n] * (middle - self.start[n]))
        if self.tone is not SILENT:
            straight = straight + self.gain[n] * self._summed(trips) * self._swing(middle)
        return np.where(rigid, straight, 0.0)

    def breaks(self) -> list[tuple[int, float]]:
        """Return the round trips and offsets (s) where segments begin; an edge between two round trips is offset 0 of the later."""
        return breaks_of(self.start, self.round_trip_time)

    def edges(self, low: float, high: float) -> Floats:
        """Return the times (s) between two others when segments arrive or a tone has turned by about 1 rad."""
        turns = math.floor(self._turns(high - low))
        inside = self.start[(self.start > low) & (self.start < high)]
        return np.unique(np.concatenate([inside, np.linspace(low, high, turns + 2)[1:-1]])) if turns else inside

    def many_edges(self, low: float, high: float) -> float:
        """Return the number of times that `edges` returns, at most."""
        return len(self.start) + 1.0 + self._turns(high - low)

    def _turns(self, lasting: float) -> float:
        """Return the number of times that the tone turns by 1 rad in a time (s)."""
        return lasting * self.tone.frequency if self.tone.amplitude != 0.0 else 0.0

    def segment(self, time: Floats) -> NDArray[np.intp]:
        """Return the segment that has arrived at each time (s)."""
        return np.maximum(np.searchsorted(self.start, time, side="right") - 1, 0)

    def _up_to(self, n: NDArray[np.intp], time: Floats) -> Floats:
        lasting = np.diff(self.start)
        whole = np.append(0.0, np.cumsum(lasting * (self.value[:-1] + 0.5 * self.slope[:-1] * lasting)))
        since = time - self.start[n]
        return np.asarray(whole[n] + since * (self.value[n] + 0.5 * self.slope[n] * since))

    def _summed(self, trips: Floats) -> Floats:
        """Return the sum of the tone over the given number of round trips, divided by the tone at their mean time."""
        from stickslip.engine.waves.tone import dirichlet  # compiled, which `stickslip check` does without

        return np.array([dirichlet(count, self.tone.frequency * self.round_trip_time) for count in trips.tolist()])

    def _swung(self, low: Floats, high: Floats) -> Floats:
        """Return the integral of the tone between times (s)."""
        frequency = self.tone.frequency
        return np.asarray(2.0 / frequency * np.sin(0.5 * frequency * (high - low)) * self._swing(0.5 * (low + high)))

    def _swing(self, time: Floats) -> Floats:
        return np.asarray(self.tone.amplitude * np.sin(self.tone.frequency * time + self.tone.phase))


EDGE = 1e-13
"""Distance from the edge of a round trip, as a share of it, within which a break lies on the edge."""


def breaks_of(start: Floats, round_trip_time: float, joined: bool = False) -> list[tuple[int, float]]:
    """Return the round trips and offsets (s) of times (s); an edge between two round trips is offset 0 of the later.

    If `joined`, offsets that differ by rounding become one, so that breaks that come in every round trip cut it at one place.
    """
    trips = np.floor(start / round_trip_time)
    offsets = start - trips * round_trip_time
    rounding = max(EDGE * round_trip_time, 8.0 * float(np.spacing(start[-1]))) if joined else EDGE * round_trip_time
    late, early = offsets > round_trip_time - rounding, offsets < rounding
    offsets[late | early] = 0.0
    if joined:
        order = np.argsort(offsets, kind="stable")
        ranked = offsets[order]
        first = np.append(True, np.diff(ranked) > rounding)
        offsets[order] = ranked[first][np.cumsum(first) - 1]
    return list(zip((trips + late).astype(int).tolist(), offsets.tolist(), strict=True))


class Pressing(NamedTuple):
    """A normal load that varies, as growth since the start, as a share of the normal load there (1)."""

    start: Floats  # s: times at which its straight parts begin
    value: Floats
    slope: Floats  # 1/s
    tone: Tone


def pressing_of(problem: Problem) -> Pressing:
    """Return the growth of a normal load; one part without growth if it is constant."""
    history = problem.normal_load
    if history is None:
        return Pressing(np.zeros(1), np.zeros(1), np.zeros(1), SILENT)
    segments, tone = _scaled(history, 1.0 / problem.normal)
    start, value, slope = np.array(segments).T
    return Pressing(start, value - 1.0, slope, tone)


def wave_before(problem: Problem) -> Any:
    """Return the wave beta - 2 Z v, minus the reference strength (Pa), that leaves the contact of a slab just before the start."""
    return problem.excess - 2.0 * problem.body.impedance * problem.rate


def far_excess(problem: Problem) -> Any:
    """Return the default far stress, that in the slab at the start, minus the reference strength (Pa)."""
    return problem.excess - problem.body.impedance * problem.rate


def far_at_first(problem: Problem) -> Any:
    """Return the stress behind the last layer, or behind a slab, at the start, minus the reference strength (Pa)."""
    body, rate = problem.body, problem.rate
    if not isinstance(body, OfLayers):
        return far_excess(problem)
    held = float(body.stacks[0].held(rate, rate + problem.initial_shear)[-1])
    return share_of_first(problem) * far_excess(problem) + held


def share_of_first(problem: Problem) -> float:
    """Return the share (1) of the load, and of the far stress, that the first side of a body bears."""
    body = problem.body
    return body.stacks[0].stiffness / body.stiffness if isinstance(body, OfLayers) and body.is_joined else 1.0


def steady_inflow(problem: Problem) -> tuple[float, float]:
    """Return the inflow of a loading that does not vary: its value at 0 s and its growth per second. Slab: Pa; block: N/s."""
    body = problem.body
    if not body.has_waves:
        return body.stiffness * problem.first_pull_rate, 0.0
    if not (body.is_uniform or body.has_machine):
        return 0.0, 0.0  # each driver behind layers has its own, in `ladder`
    if body.is_driven_rigidly:
        return 2.0 * body.impedance * problem.first_pull_rate, 0.0
    gain, far = gain_of(body), problem.far_stress
    assert not isinstance(far, LoadingHistory)
    excess = far_at_first(problem) if far is None else far - problem.strength
    growth, delay = problem.far_stress_rate, body.inflow_delay
    return gain * body.driver_impedance * problem.first_pull_rate + gain * (excess - growth * delay), gain * growth


def steady_ramp(problem: Problem) -> float:
    """Return the growth of the load of a body with waves at rest in one round trip (Pa), under a loading that does not vary."""
    body = problem.body
    if not body.is_driven_rigidly:
        return problem.far_stress_rate * body.round_trip_time
    if body.is_uniform:
        return 2.0 * body.impedance * problem.first_pull_rate
    return body.stiffness * problem.first_pull_rate * body.round_trip_time


def gain_of(body: BodyOnCharacteristics) -> Any:
    """Return the share (1) of the stress of a driver that it sends to the contact; 1 for a machine, which the stress moves."""
    return 1.0 if body.has_machine else 1.0 + body.reflection


def machine_at_first(problem: Problem) -> tuple[float, float]:
    """Return the rate (m/s) of a machine when the first wave of the run leaves it, and the force of its integral gain (Pa).

    A machine with a mass starts at the pull rate; without mass the balance of forces sets its rate at once. The integral is 0 at
    the start, so that a far stress that does not balance the stress in the slab acts as a jump, whatever the gain: it accelerates
    the machine. The smaller the gain, the closer the motion comes to that without one.
    """
    body = problem.body
    if body.driver_inertia > 0.0:
        return problem.first_pull_rate, 0.0
    if isinstance(body, OfLayers):
        force = float(inflow_of(problem).at(np.array(0.0)))
        left = body.last_impedance * (problem.rate + problem.initial_shear) - far_at_first(problem)
    else:
        force = float(inflow_of(problem).at(np.array(0.5 * body.round_trip_time)))
        left = body.impedance * problem.initial_shear - wave_before(problem)
    return (force + left) / (body.last_impedance + body.driver_impedance), 0.0


def tone_of(problem: Problem) -> Tone:
    """Return the sinusoid of the loading: that of the pull or, if it has none, that of the ground (of its velocity, m/s)."""
    inflow = inflow_of(problem).tone
    return inflow if problem.ground is None or inflow.amplitude != 0.0 or not problem.body.has_waves else problem.ground.tone


def settled_rate(problem: Problem, time: Floats) -> Floats:
    """Return the rate (m/s) that a machine tends to while the contact rests, under the loading that has arrived at times (s).

    See `engine.waves.driver_at_rest`.
    """
    body, pull, driven = problem.body, pull_of(problem), inflow_of(problem)
    gain = body.driver_integral_gain
    grows = driven.slope[driven.segment(time)] - body.driver_impedance * pull.slope[pull.segment(time)]
    stiffness = ramp_per_rate(problem) / problem.round_trip_time
    return np.asarray((gain * pull.value[pull.segment(time)] + grows) / (gain + stiffness))


def ramp_per_rate(problem: Problem) -> Any:
    """Return the growth of the load at rest in one round trip over the rate of the driver (Pa s/m)."""
    body = problem.body
    return 2.0 * body.impedance if body.is_uniform else body.stiffness * body.round_trip_time


def pull_of(problem: Problem) -> Inflow:
    """Return the pull rate (m/s) of a machine, as it arrives at the contact."""
    if isinstance(problem.pull_rate, LoadingHistory):
        delay = 0.5 * problem.round_trip_time if problem.body.is_uniform else 0.0
        return _inflow(*_scaled(problem.pull_rate, 1.0), delay, problem)
    return _inflow([Segment(0.0, problem.pull_rate, 0.0)], SILENT, 0.0, problem)


@lru_cache(maxsize=64)
def inflow_of(problem: Problem) -> Inflow:
    """Return the inflow of a problem."""
    body = problem.body
    if not body.has_waves and problem.ground is not None:
        return _shaken_block(problem, problem.ground)
    if not problem.loading_varies:
        value, slope = steady_inflow(problem)
        return _inflow([Segment(0.0, value, slope)], SILENT, 0.0, problem)
    if not body.has_waves:
        return _inflow(*_scaled(problem.pull_rate, body.stiffness), 0.0, problem)
    delay = body.inflow_delay
    if problem.driver_changes:
        return _through_changes(problem)
    if body.is_driven_rigidly:
        return _inflow(*_scaled(problem.pull_rate, 2.0 * body.last_impedance), delay, problem)
    return _inflow(*_lossy(problem), delay, problem)


def _shaken_block(problem: Problem, ground: Ground) -> Inflow:
    """Return the growth of a block's load where the ground moves: K V - m a', with a the acceleration of the ground."""
    mass, pull = problem.body.inertia, problem.pull_rate
    segments, tone = _scaled(pull, problem.body.stiffness) if isinstance(pull, LoadingHistory) else ([], SILENT)
    segments = segments or [Segment(0.0, steady_inflow(problem)[0], 0.0)]
    pulled = _inflow(segments, tone, 0.0, problem)
    start = np.union1d(pulled.start, ground.start)
    of_pull, of_ground = pulled.segment(start), np.searchsorted(ground.start, start, side="right") - 1
    value = pulled.value[of_pull] + pulled.slope[of_pull] * (start - pulled.start[of_pull]) - mass * ground.jerk[of_ground]
    amplitude, frequency, phase = ground.tone
    if amplitude != 0.0:
        tone = Tone(mass * amplitude * frequency * frequency, frequency, phase)
    return replace(pulled, start=start, value=value, slope=pulled.slope[of_pull], tone=tone)


def _through_changes(problem: Problem) -> Inflow:
    """Return the inflow through a driver that changes."""
    (pull, pull_tone), (far, far_tone) = (_in_parts(value) for value in (problem.pull_rate, problem.far_stress))
    body, steps, bears = problem.body, np.array(problem.driver_steps), share_of_first(problem)
    start = np.unique(np.concatenate([pull[0], far[0], steps[:, 0]]))
    share = steps[np.searchsorted(steps[:, 0], start, side="right") - 1, 1]
    of_pull, of_far = body.last_impedance * (1.0 - share), 1.0 + share
    pulled, stressed = (_straight(one, start) for one in (pull, far))
    beyond = far_at_first(problem) if problem.far_stress is None else bears * (stressed[0] - problem.strength)
    value = of_pull * pulled[0] + of_far * (beyond + bears * problem.far_stress_rate * start)
    slope = of_pull * pulled[1] + of_far * bears * (stressed[1] + problem.far_stress_rate)
    tone, gain = (far_tone, of_far * bears) if pull_tone is SILENT else (pull_tone, of_pull)
    made = _inflow([Segment(*one) for one in zip(start, value, slope, strict=True)], tone, body.inflow_delay, problem)
    return replace(made, reflection=share, gain=gain)


def _in_parts(value: float | LoadingHistory | None) -> tuple[Floats, Tone]:
    """Return the starts (s), values and slopes (rows) of what may vary in time, and its tone; None stands for 0."""
    segments, tone = _scaled(value, 1.0) if isinstance(value, LoadingHistory) else ([Segment(0.0, value or 0.0, 0.0)], SILENT)
    return np.array(segments).T, tone


def _straight(parts: Floats, start: Floats) -> tuple[Floats, Floats]:
    """Return the values and the slopes of straight parts (rows as of `_in_parts`), from times (s) on."""
    own, value, slope = parts
    n = np.searchsorted(own, start, side="right") - 1
    return value[n] + slope[n] * (start - own[n]), slope[n]


def _lossy(problem: Problem) -> tuple[list[Segment], Tone]:
    """Return the segments and the tone of far stress and pull rate together, as they leave a driver of finite impedance.

    One of the two varies.
    """
    body, far = problem.body, problem.far_stress
    gain = gain_of(body)
    if isinstance(far, LoadingHistory):
        segments, tone = _scaled(far, gain)
        steady = gain * (body.driver_impedance * problem.first_pull_rate - problem.strength)
    else:
        segments, tone = _scaled(problem.pull_rate, gain * body.driver_impedance)
        steady = gain * (far_at_first(problem) if far is None else far - problem.strength)
    growth = gain * problem.far_stress_rate
    return [Segment(s.start, s.value + steady + growth * s.start, s.slope + growth) for s in segments], tone


def _scaled(history: float | LoadingHistory, gain: float) -> tuple[list[Segment], Tone]:
    assert isinstance(history, LoadingHistory)
    amplitude, frequency, phase = history.tone
    tone = Tone(gain * amplitude, frequency, phase) if amplitude != 0.0 else SILENT
    return [Segment(s.start, gain * s.value, gain * s.slope) for s in history.segments], tone


def _inflow(segments: list[Segment], tone: Tone, delay: float, problem: Problem) -> Inflow:
    """Return the inflow as it arrives at the contact, after the delay (s).

    The first segment is extended back to 0 s: nothing asks for the inflow before the delay is over.
    """
    body = problem.body
    start, value, slope = np.array(segments).T
    start = start + delay
    value[0], start[0] = value[0] - slope[0] * delay, 0.0
    late = tone if tone is SILENT else Tone(tone.amplitude, tone.frequency, tone.phase - tone.frequency * delay)
    shares, ones = np.full(len(start), float(body.reflection)), np.ones(len(start))
    return Inflow(start, value, slope, late, problem.round_trip_time, not body.has_waves, shares, ones)
