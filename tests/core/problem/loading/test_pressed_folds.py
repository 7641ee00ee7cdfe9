"""Perfect delay of a slab without contact mass whose normal stress varies, so that the folds of its contact equation move.

The own program below knows neither branches nor folds. At each moment the slip rate moves from its last value towards the load, up
to the first rate that solves Z v + S(t) mu(v) = beta(t): the limit of a contact mass that vanishes. Echoes are looked up in the
values before.
"""

from __future__ import annotations

import bisect
import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from stickslip.problem.scenarios.scenario import Scenario
from stickslip.run.check.examine import warnings_of

FASTEST, FINE = 40.0, 801
"""Slip rates (m/s) are sought up to FASTEST, first among FINE places."""
RATES = np.concatenate([[0.0], np.geomspace(1e-9, FASTEST, FINE)])
TRIP = 2.0
"""Round trip (s) of a slab with Z = 1 Pa s/m, and h/c = 1 s."""
BESIDE = 1e-10
"""Jumps are known to a tenth of this (s), and limits are taken this far from them."""
STEPS = 120
"""Moments in a round trip at which the own program looks."""
SMOOTH, JUMP = 0.02, 0.05
"""The own program looks twice as often where the slip rate changes by more than SMOOTH; changes of at least JUMP at once (m/s) are
compared."""

Friction = Callable[[Any], Any]


@dataclass
class Drawn:
    """A law: what the engine is given, and mu(v) with its derivative as plain functions."""

    law: ss.friction.FrictionLaw
    mu: Friction
    slope: Friction
    knots: tuple[float, ...] = ()


def hyperbolic(rng: np.random.Generator) -> Drawn:
    static, drop, alpha = rng.uniform(0.5, 0.8), rng.uniform(0.1, 0.3), rng.uniform(0.3, 4.0)
    law = ss.friction.HyperbolicRate(static, static - drop, alpha)
    return Drawn(law, lambda v: static - drop + drop / (1.0 + alpha * v), lambda v: -drop * alpha / (1.0 + alpha * v) ** 2)


def stribeck(rng: np.random.Generator) -> Drawn:
    """Friction that falls exponentially, and slowly grows: typed."""
    m, d, r, c = rng.uniform(0.3, 0.5), rng.uniform(0.1, 0.3), rng.uniform(0.1, 0.6), rng.uniform(0.0, 0.03)
    law = ss.friction.FromExpression("m + d*exp(-v/r) + c*v", {"m": m, "d": d, "r": f"{r!r} m/s", "c": f"{c!r} s/m"})
    return Drawn(law, lambda v: m + d * np.exp(-v / r) + c * v, lambda v: c - d / r * np.exp(-v / r))


def hump(rng: np.random.Generator) -> Drawn:
    """Friction that first grows with the slip rate, then falls: slip begins gently, and a branch ends above."""
    m, d, r = rng.uniform(0.3, 0.5), rng.uniform(0.1, 0.3), rng.uniform(0.05, 0.3)
    law = ss.friction.FromExpression("m + d*v/r*exp(1 - v/r)", {"m": m, "d": d, "r": f"{r!r} m/s"})
    return Drawn(law, lambda v: m + d * v / r * np.exp(1.0 - v / r), lambda v: d / r * (1.0 - v / r) * np.exp(1.0 - v / r))


def waves(rng: np.random.Generator) -> Drawn:
    """Friction that waves: up to four branches."""
    m, d, r, k = rng.uniform(0.4, 0.5), rng.uniform(0.1, 0.2), rng.uniform(0.5, 1.0), rng.uniform(6.0, 9.0)
    numbers = {"m": m, "d": d, "r": f"{r!r} m/s", "k": f"{k!r} s/m"}
    law = ss.friction.FromExpression("m + d*cos(k*v)*exp(-v/r)", numbers)

    def slope(v: Any) -> Any:
        return -d * np.exp(-v / r) * (k * np.sin(k * v) + np.cos(k * v) / r)

    return Drawn(law, lambda v: m + d * np.cos(k * v) * np.exp(-v / r), slope)


def bent(rng: np.random.Generator) -> Drawn:
    """Straight lines between points: branches end at knots."""
    rates = np.array([0.0, *np.sort(rng.uniform(0.05, 1.5, 3))])
    values = np.array([0.6, 0.6 + rng.uniform(-0.1, 0.1), rng.uniform(0.3, 0.5), rng.uniform(0.3, 0.5)])
    law = ss.friction.PiecewiseLinearRate(rates.tolist(), values.tolist())
    return Drawn(law, lambda v: np.interp(v, rates, values), lambda v: 0.0 * v, tuple(rates))


def restless(rng: np.random.Generator) -> Drawn:
    """Friction without rest: it grows from zero, and falls."""
    m, d, r, e = rng.uniform(0.2, 0.4), rng.uniform(0.2, 0.4), rng.uniform(0.1, 0.6), rng.uniform(0.01, 0.05)
    numbers = {"m": m, "d": d, "r": f"{r!r} m/s", "e": f"{e!r} m/s"}
    law = ss.friction.FromExpression("v/(v + e)*(m + d*exp(-v/r))", numbers)

    def slope(v: Any) -> Any:
        return e / (v + e) ** 2 * (m + d * np.exp(-v / r)) - v / (v + e) * d / r * np.exp(-v / r)

    return Drawn(law, lambda v: v / (v + e) * (m + d * np.exp(-v / r)), slope)


LAWS = {one.__name__: one for one in (hyperbolic, stribeck, hump, waves, bent, restless)}


@dataclass
class Crawl:
    """The own program: times with slip rates (positive forwards), each after the jump if there is one, and the jumps."""

    drawn: Drawn
    normal: LoadingHistory
    load: float
    pull: float
    reflection: float
    times: list[float] = field(default_factory=list)
    rates: list[float] = field(default_factory=list)
    jumps: list[tuple[float, float, float]] = field(default_factory=list)
    looks: list[float] = field(default_factory=list)

    def beta(self, t: float, side: float) -> float:
        """Return the wave that arrives (Pa); `side` is a little more or less than t, for the limits at a jump."""
        far = (1.0 - self.reflection) * self.pull + (1.0 + self.reflection) * self.load  # 2 Z (Zd V + s)/(Z + Zd), s = load
        if side < (TRIP if self.reflection == -1.0 else 0.5 * TRIP):
            return self.load + self.pull * t
        if side < TRIP:
            return self.reflection * (self.pull * (TRIP - t) - self.load) + far
        before = t - TRIP
        return self.reflection * (2.0 * self.rate(before, side - TRIP) - self.beta(before, side - TRIP)) + far

    def pressed(self, t: float, side: float) -> float:
        """Return the normal stress (Pa), at a jump on the given side."""
        one = [one for one in self.normal.segments if one.start <= side][-1]
        tone = self.normal.tone
        return one.at(t) + tone.amplitude * math.sin(tone.frequency * t + tone.phase)

    def rate(self, t: float, side: float) -> float:
        """Return the slip rate at a time in the past."""
        n = max(bisect.bisect_right(self.times, side) - 1, 0)
        return self.moved(self.rates[n], t, side)

    def moved(self, rate: float, t: float, side: float) -> float:
        """Return where the slip rate goes at a time, from a slip rate just before."""
        beta, normal = self.beta(t, side), self.pressed(t, side)
        way = math.copysign(1.0, rate or beta)
        found = self.towards(abs(rate), way * beta, normal)
        if found == 0.0 and -way * beta > normal * self.drawn.mu(0.0):  # it turns round
            return -way * self.towards(0.0, -way * beta, normal)
        return way * found

    def towards(self, rate: float, beta: float, normal: float) -> float:
        """Return the first rate that solves the contact equation on the way from a rate towards the load."""

        def short(v: Any) -> Any:
            return beta - v - normal * self.drawn.mu(v)

        if rate == 0.0 and beta <= normal * self.drawn.mu(0.0):
            return 0.0
        if rate > 0.0 and abs(short(rate)) < 1e-14 * normal:
            return rate
        rises = rate == 0.0 or short(rate) > 0.0
        path = self.turns(normal)
        path = path[path > rate] if rises else path[path < rate][::-1]
        beyond = short(path) <= 0.0 if rises else short(path) >= 0.0
        if not rises and not beyond.any():
            return 0.0
        n = int(np.argmax(beyond))
        if path[n] == 0.0:
            return 0.0  # the load is below every slower rate's: rest holds it
        start = rate if n == 0 else float(path[n - 1])
        return float(brentq(short, start, float(path[n]), xtol=1e-15, rtol=1e-15))

    def turns(self, normal: float) -> Any:
        """Return rates so that Z v + S mu is monotone between them."""
        slope = 1.0 + normal * self.drawn.slope(RATES)
        turn = np.flatnonzero(slope[1:] * slope[:-1] < 0.0)
        found = [brentq(lambda v: 1.0 + normal * self.drawn.slope(v), RATES[n], RATES[n + 1], xtol=1e-15) for n in turn]
        return np.sort(np.concatenate([RATES, self.drawn.knots, found]))

    def run(self, duration: float) -> None:
        """March to the end, from one look to the next; breaks of the loading and jumps are looked at again when they echo."""
        breaks = {0.0, *(one.start for one in self.normal.segments)}
        trips = range(int(2.0 * duration / TRIP) + 1)
        edges = {s + k * 0.5 * TRIP for s in breaks for k in trips if s + k * 0.5 * TRIP < duration}
        even = np.linspace(0.0, duration, round(STEPS * duration / TRIP) + 1)
        self.looks = sorted({*even.tolist(), *edges})
        now, self.times, self.rates = 0.0, [-1.0], [0.0]
        while len(self.looks) > 1:
            begin, end = self.looks.pop(0) + BESIDE, self.looks[0]
            here = self.moved(now, begin, begin)
            self.note(begin, now, here)
            now = self.walk(begin, here, end - BESIDE)

    def walk(self, begin: float, here: float, end: float) -> float:
        """Go from one moment to another, halving the way where the slip rate changes much; return the slip rate there."""
        there = self.moved(here, end, end)
        if abs(there - here) < SMOOTH:
            return there
        if end - begin < 0.1 * BESIDE:
            self.note(end, here, there)
            return there
        middle = 0.5 * (begin + end)
        here = self.walk(begin, here, middle)
        self.note(middle, here, here)
        return self.walk(middle, here, end)

    def note(self, t: float, before: float, after: float) -> None:
        """Keep a moment, and the jump of the slip rate there."""
        if abs(after - before) >= SMOOTH:
            self.jumps.append((t, before, after))
            for echo in np.arange(t + TRIP, self.looks[-1], TRIP).tolist():
                n = bisect.bisect(self.looks, echo)
                if min(self.looks[n] - echo, echo - self.looks[n - 1]) > 1e-9:
                    self.looks.insert(n, echo)
        self.times.append(t)
        self.rates.append(after)


NORMAL, DURATION = 10.0, 7.0
DRIVERS = {"rigid": -1.0, "matched": 0.0, "stiff": -0.5, "soft": 0.5}


def history(rng: np.random.Generator, kind: str) -> LoadingHistory:
    """Return steps, ramps or a sinusoid of the normal stress."""
    if kind == "sinusoid":
        return Sinusoidal(NORMAL, float(rng.uniform(1.0, 6.0)), float(rng.uniform(0.4, 5.0)))
    times = [0.0, *np.sort(rng.uniform(0.1, DURATION, 6)).tolist()]
    values = [NORMAL, *(NORMAL * rng.uniform(0.3, 1.7, 6)).tolist()]
    return Steps(times, values) if kind == "steps" else PiecewiseLinear(times, values)


def case(law: str, kind: str, driver: str, seed: int) -> tuple[ss.Problem, Crawl]:
    """Return a problem, and the own program for it."""
    rng = np.random.default_rng([seed, *map(ord, law + kind + driver)])
    drawn, pressed, r = LAWS[law](rng), history(rng, kind), DRIVERS[driver]
    way = float(rng.choice([-1.0, 1.0]))
    load, pull = way * NORMAL * float(drawn.mu(0.0) or 0.5) * float(rng.uniform(0.6, 1.05)), way * float(rng.uniform(0.0, 0.6))
    impedance = math.inf if r == -1.0 else (1.0 - r) / (1.0 + r)
    slab = ss.ElasticSlab(density=1.0, wave_speed=1.0, thickness=1.0, normal_stress=NORMAL, driver_impedance=impedance)
    problem = ss.Problem(slab, drawn.law, pull_rate=pull, initial_load=load, normal_load=pressed)
    return problem, Crawl(drawn, pressed, load, pull, r)


def drawn_cases() -> list[tuple[str, str, str, int]]:
    """Return a case for each law and kind of history; every driver occurs."""
    both = [(law, kind) for law in LAWS for kind in ("steps", "ramps", "sinusoid")]
    return [(law, kind, list(DRIVERS)[(n + n // 4) % 4], n % 5) for n, (law, kind) in enumerate(both)]


def compare(run: ss.Solution, own: Crawl) -> None:
    """Compare slip rates to 1e-6 m/s and jumps to 1e-6 s."""
    jumped = np.array([-9.0, *(t for t, _, _ in own.jumps), *run.shocks.time])
    t = np.array(own.times[1:])
    far = (abs(t[:, None] - jumped).min(axis=1) > 1e-5) & (t < DURATION)
    assert run.slip_rate(t[far]) == pytest.approx(np.array(own.rates[1:])[far], abs=1e-6)
    large = run.shocks[abs(run.shocks.rate_after - run.shocks.rate_before) >= JUMP]
    known = [(t, after) for t, before, after in own.jumps if abs(after - before) >= JUMP]
    assert large.time.to_numpy() == pytest.approx([t for t, _ in known], abs=1e-6)
    assert large.rate_after.to_numpy() == pytest.approx([after for _, after in known], abs=1e-4)


@pytest.mark.sampled(every=18)
@pytest.mark.parametrize(("law", "kind", "driver", "seed"), drawn_cases())
def test_slip_rates_and_jumps_are_those_of_an_own_program(law: str, kind: str, driver: str, seed: int) -> None:
    problem, own = case(law, kind, driver, seed)
    own.run(DURATION)
    run = ss.simulate(problem, DURATION)
    compare(run, own)
    assert run.proven.relative < 1e-9
    assert float(run.energy(DURATION).balance.item()) == pytest.approx(0.0, abs=1e-8)


@dataclass
class Chosen(Crawl):
    """The own program under a rule that knows no past: the smallest or the largest stable rate, or that of equal areas."""

    rule: str = "minimal"

    def towards(self, rate: float, beta: float, normal: float) -> float:
        path = self.turns(normal)
        beyond = path + normal * self.drawn.mu(path) - beta
        rests = bool(beta <= normal * self.drawn.mu(0.0))
        n = np.flatnonzero((beyond[:-1] < 0.0) & (beyond[1:] >= 0.0))
        found = [float(brentq(lambda v: v + normal * self.drawn.mu(v) - beta, path[k], path[k + 1], xtol=1e-15)) for k in n]
        stable = [0.0] * rests + [one for one in found if one > 1e-12]
        if self.rule == "maxwell":
            area = {one: quad(lambda v: v + normal * self.drawn.mu(v) - beta, 0.0, one)[0] for one in stable}
            return min(area, key=area.__getitem__, default=0.0)
        return (min if self.rule == "minimal" else max)(stable, default=0.0)


@pytest.mark.parametrize(
    ("law", "rule", "driver"),
    [
        pytest.param("hyperbolic", "maxwell", "stiff", marks=pytest.mark.slow),
        ("hyperbolic", "maximal", "matched"),
        pytest.param("waves", "minimal", "stiff", marks=pytest.mark.slow),
        pytest.param("waves", "maximal", "stiff", marks=pytest.mark.slow),
    ],
)
def test_other_rules_choose_anew_at_every_step_of_the_normal_stress(law: str, rule: str, driver: str) -> None:
    problem, own = case(law, "steps", driver, 7)
    chosen = Chosen(own.drawn, own.normal, own.load, own.pull, own.reflection, rule=rule)
    chosen.run(DURATION)
    compare(ss.simulate(replace(problem, selection=rule), DURATION), chosen)


MATCHED = ss.ElasticSlab(density=1.0, wave_speed=1.0, thickness=1.0, normal_stress=10.0, driver_impedance=1.0)
STATIC, DROP, ALPHA = 0.6, 0.2, 2.0


def test_under_a_constant_load_a_ramp_of_the_normal_stress_is_one_of_the_load() -> None:
    """Slip begins when load / S is mu_static, and ends at the fold S mu1 = S muD + (Z/alpha) (2 q - 1), q^2 = alpha S drop/Z."""
    load, law = 5.7, ss.friction.HyperbolicRate(STATIC, STATIC - DROP, ALPHA)
    falls, grows = -0.1, 0.7
    pressed = PiecewiseLinear([0.0, 10.0, 30.0], [10.0, 10.0 + 10.0 * falls, 9.0 + 20.0 * grows])
    run = ss.simulate(ss.Problem(MATCHED, law, initial_load=load, normal_load=pressed), 30.0)

    def fold(normal: float) -> float:
        return normal * (STATIC - DROP) + (2.0 * math.sqrt(ALPHA * normal * DROP) - 1.0) / ALPHA

    begins, ends = (load / STATIC - 10.0) / falls, 10.0 + (brentq(lambda s: fold(s) - load, 9.0, 23.0) - 9.0) / grows
    assert run.shocks.time.to_numpy() == pytest.approx([begins, ends], rel=1e-11)
    assert run.shocks.cause.to_list() == ["fold", "fold"]
    normal = load / STATIC
    leaps = (normal * DROP * ALPHA - 1.0) / ALPHA  # Z v + S (muD + drop / (1 + alpha v)) = load, but for v = 0
    assert run.shocks.rate_after.to_numpy() == pytest.approx([leaps, 0.0], rel=1e-11)
    v1 = (math.sqrt(ALPHA * (9.0 + grows * (ends - 10.0)) * DROP) - 1.0) / ALPHA
    assert run.shocks.rate_before.to_numpy() == pytest.approx([0.0, v1], rel=1e-6)


def test_folds_move_with_slip_and_normal_stress_at_once() -> None:
    """mu = m + d exp(-v / r) + k u under a constant load: an own integration in a time that stands still at folds."""
    m, d, r, k, load = 0.4, 0.2, 0.3, 0.02, 5.8
    law = ss.friction.FromExpression("m + d*exp(-v/r) + k*u", {"m": m, "d": d, "r": f"{r} m/s", "k": f"{k} /m"})
    pressed = PiecewiseLinear([0.0, 2.0, 20.0], [10.0, 9.0, 15.0])
    run = ss.simulate(ss.Problem(MATCHED, law, initial_load=load, normal_load=pressed), 20.0)
    begins = (10.0 - load / (m + d)) / 0.5
    start = float(brentq(lambda v: v + load / (m + d) * (m + d * math.exp(-v / r)) - load, 0.3, 3.0, xtol=1e-15))

    def change(_: float, y: Any) -> list[float]:
        t, v, u = y
        slope = -0.5 if part == 0 else 1.0 / 3.0
        normal = 10.0 - 0.5 * t if part == 0 else 9.0 + (t - 2.0) / 3.0
        still = 1.0 - normal * d / r * math.exp(-v / r)
        return [still, -slope * (m + d * math.exp(-v / r) + k * u) - normal * k * v, v * still]

    def at_fold(_: float, y: Any) -> float:
        return 1.0 - (9.0 + (y[0] - 2.0) / 3.0) * d / r * math.exp(-y[1] / r)

    part, settings = 0, {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
    ends: Any = lambda _, y: y[0] - 2.0  # noqa: E731 # an event needs an attribute
    ends.terminal = at_fold.terminal = True  # type: ignore[attr-defined]
    first = solve_ivp(change, (0.0, 100.0), [begins, start, 0.0], events=ends, **settings).y[:, -1]
    part = 1
    t, v, u = solve_ivp(change, (0.0, 1000.0), [2.0, first[1], first[2]], events=at_fold, **settings).y[:, -1]
    assert run.shocks.time.to_numpy() == pytest.approx([begins, t], abs=1e-8)
    assert run.shocks.rate_before.to_numpy() == pytest.approx([0.0, v], abs=1e-5)
    assert float(run.slip(20.0)) == pytest.approx(u, rel=1e-9)


@pytest.mark.slow
def test_a_run_is_resumed_to_the_bit_while_its_folds_move(tmp_path: Path) -> None:
    problem, _ = case("stribeck", "sinusoid", "stiff", 1)
    whole = ss.simulate(problem, DURATION)
    ss.simulate(problem, 0.4 * DURATION, checkpoint=tmp_path / "part.nc")
    assert np.array_equal(ss.resume(tmp_path / "part.nc", DURATION).history.store.rate, whole.history.store.rate)
    assert ss.open_solution(whole.to_netcdf(tmp_path / "whole.nc")).problem == problem


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ((10.0, 12.0), "varies from 10 Pa to 12 Pa: the contact is irregular under all of it, and the folds move with it."),
        (
            (2.0, 4.0),
            "varies from 2 Pa to 4 Pa: the contact is regular up to 2.5 Pa and irregular above, where the folds move with it.",
        ),
        ((2.0, 2.4), "varies from 2 Pa to 2.4 Pa: the contact is regular under all of it."),
    ],
)
def test_uniqueness_says_under_which_normal_loads_the_contact_is_irregular(values: tuple[float, float], said: str) -> None:
    slab, law = replace(MATCHED, normal_stress=values[0]), ss.friction.HyperbolicRate(STATIC, STATIC - DROP, ALPHA)
    problem = ss.Problem(slab, law, initial_load=1.0, normal_load=PiecewiseLinear([0.0, 9.0], values))
    assert ss.uniqueness(problem).summary.endswith(said)
    matters = "irregular" in said
    assert ("depends on the rule" in ss.simulate(problem, 1.0).rule_influence.note) == matters
    chosen = replace(problem, selection="minimal")
    warnings = " ".join(warnings_of(Scenario(chosen, 1.0), ss.uniqueness(chosen)))
    assert ("cannot be run: selection 'minimal'" in warnings) == matters
    assert ("has no effect" in warnings) != matters
