"""The problems of one contact for other programs.

Each asks one thing of a program. A scheme that passes all of them moves waves, rests, slips, makes shocks and follows the rule that
it claims.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from stickslip.extensions.schemes.benchmark_kinds import Benchmark
from stickslip.friction import Coulomb, HyperbolicRate, LinearSlipWeakening, SinusoidalSlip
from stickslip.problem import PiecewiseLinear, Problem
from stickslip.problem.bodies import ElasticSlab
from stickslip.problem.scenarios import Scenario, load_scenario

ROCK = ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
"""The slab of the paper."""
MATCHED = replace(ROCK, driver_impedance=ROCK.impedance)
"""The same slab under a half-space of the same rock, which reflects nothing."""


def _smooth() -> Scenario:
    law = SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=2.0)
    return Scenario(Problem(ROCK, law, pull_rate=0.3, initial_slip=math.pi / 4, initial_excess=0.0), 8.0)


def _at_the_maximum() -> Scenario:
    law = SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=50.0)
    excess = 5e7 * (1.0 - math.cos(0.05))
    return Scenario(Problem(ROCK, law, initial_slip=math.pi / 100 + 1e-3, initial_excess=excess), 5.7)


def _weakening(slab: ElasticSlab) -> Scenario:
    law = LinearSlipWeakening(static=0.677, dynamic=0.525, distance=0.4)
    rock = replace(slab, density=2670.0, wave_speed=3464.0, normal_stress=1.2e8)
    rock = rock if math.isinf(slab.driver_impedance) else replace(rock, driver_impedance=rock.impedance)
    return Scenario(Problem(rock, law, initial_excess=3.6e5), 12.0)


def _coulomb() -> Scenario:
    return Scenario(Problem(ROCK, Coulomb(static=0.8, dynamic=0.3), pull_rate=1e-6, initial_excess=0.0), 9.0)


def _regular() -> Scenario:
    law = HyperbolicRate(static=0.8, dynamic=0.3, alpha=0.1)
    return Scenario(Problem(ROCK, law, pull_rate=0.5, initial_excess=0.0), 12.0)


def _dwell() -> Scenario:
    law = HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    return Scenario(Problem(MATCHED, law, initial_load=7e7, far_stress=7.5e7), 8.0)


def _soft_layer() -> Scenario:
    return replace(load_scenario("low-velocity-zone"), duration=14.0)


def _two_slabs() -> Scenario:
    plates = load_scenario("steel-on-granite").problem
    return Scenario(replace(plates, friction=Coulomb(static=0.7, dynamic=0.6)), 2e-4)


def _bow_at_a_tenth() -> Scenario:
    return replace(load_scenario("bowed-string-tenth"), duration=0.04)


def _pressed() -> Scenario:
    pressed = PiecewiseLinear([1.0, 3.0, 5.0], [1e8, 7.5e7, 1e8])
    return Scenario(Problem(ROCK, Coulomb(static=0.8, dynamic=0.6), initial_load=7e7, normal_load=pressed), 9.0)


def _shaken() -> Scenario:
    column = ElasticSlab(density=1900.0, wave_speed=160.0, thickness=20.0, normal_stress=360e3, driver_impedance=0.0)
    ground = PiecewiseLinear([0.1, 0.2, 0.4], [0.0, -0.3, 0.0])
    return Scenario(Problem(column, Coulomb(static=0.37, dynamic=0.37), initial_load=9.6e4, ground_velocity=ground), 2.0)


def _bundled(name: str) -> Callable[[], Scenario]:
    return lambda: load_scenario(name)


OF_ONE_CONTACT: tuple[Benchmark, ...] = (
    Benchmark("smooth-slip", "the order of convergence: slip begins without a shock and goes on", _smooth),
    Benchmark("linear-weakening", "a kink of the law, a shock by an echo, arrest; it has a closed form", lambda: _weakening(ROCK)),
    Benchmark("no-echo", "a driver that absorbs every wave: radiation damping alone", lambda: _weakening(MATCHED)),
    Benchmark("coulomb", "two large shocks and exact rest after one round trip of the waves", _coulomb),
    Benchmark("one-pulse", "exactly one pulse, and rest until the echo", _bundled("fig5-slab-u0-1e-2")),
    Benchmark("three-pulses", "three pulses of 8 ms at the right times, and complete arrest", _bundled("fig5-slab-reconstructed")),
    Benchmark("load-at-the-maximum", "no pulse of the grid's own: friction just holds after the first", _at_the_maximum),
    Benchmark("regular-rate", "friction of slip rate with one solution, under a fast driver", _regular),
    Benchmark("rate-shock", "an onset from the strength exactly, and two shocks of 4 m/s", _bundled("fig6-slab")),
    Benchmark("weak-shock", "a shock of 2.6e-5 m/s that must neither be lost nor grow", _bundled("fig7-slab-critical")),
    Benchmark("loop", "which selection rule: the load passes both folds", _bundled("fig4-loop"), tells_rules=True),
    Benchmark("dwell", "which selection rule: the load rises to between the folds and stays there", _dwell, tells_rules=True),
    Benchmark("soft-layer", "echoes of an interface: a soft layer makes two slips of one", _soft_layer, tells_rules=True),
    Benchmark("two-slabs", "two unlike elastic sides, whose echoes return at different times", _two_slabs, tells_rules=True),
    Benchmark(
        "bow-at-a-tenth",
        "a string on both sides of a bow, under a law of slip rate: Helmholtz' motion",
        _bow_at_a_tenth,
        tells_rules=True,
    ),
    Benchmark("varying-normal-load", "a normal load that falls and rises again: onset, slip that follows it, arrest", _pressed),
    Benchmark("moving-ground", "a column with a free top on ground that moves: slip counts from the ground", _shaken),
)
"""Problems of one contact, whose series are exact."""
