"""Problems with each kind of thing that is given: laws with states, loads, drivers, ground, on slab, block, layers, and turning."""

from __future__ import annotations

from dataclasses import replace

import stickslip as ss
from stickslip.problem.loading import PiecewiseLinear, Sinusoidal, Steps

SLAB, BLOCK = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), ss.SpringBlock(1.0, 20.0, 10.0)
WEAKENS = ss.friction.FromExpression("0.55 + 0.03*sin(3*u)*exp(-u*u) + 0.01/(1 + u*u)")
COULOMB = ss.friction.Coulomb(0.6, 0.55)
AGEING = ss.friction.RateAndState(0.6, 0.012, 0.014, 0.01, normal_stress_coupling=0.005)
LAYERS = ss.LayeredSlab([4e3, 6e3], [2600.0, 2800.0], [3000.0, 3500.0], 1e8)


def cases() -> dict[str, tuple[ss.Problem, float]]:
    """Problems by name, with durations (s): each kind of thing that is given, on a slab, on a block, on layers, and turning."""
    friction, law = ss.friction, WEAKENS
    slips = {"pull_rate": 0.3, "initial_excess": 1.5e7}
    swings, climbs = Sinusoidal(1e8, 1e6, 3.0), PiecewiseLinear([0.0, 1.0, 2.5], [1e8, 1.02e8, 0.99e8])
    pulls = Sinusoidal(0.3, 0.1, 5.0)
    soft = replace(SLAB, driver_impedance=3e6)
    machine = {"driver_impedance": 3e6, "driver_inertia": 2e6, "driver_integral_gain": 4e5}
    freed = Steps([0.0, 5.0], [SLAB.reflection, 0.5])
    rests = {"pull_rate": 0.3, "initial_excess": -2e6}
    shakes = PiecewiseLinear([0.0, 1.0, 2.0, 3.0], [0.0, 0.2, -0.1, 0.0])
    found = {
        "slab, normal load swings": (ss.Problem(SLAB, law, **slips, normal_load=swings), 4.0),
        "slab, normal load climbs": (ss.Problem(SLAB, law, **slips, normal_load=climbs), 4.0),
        "block, normal load steps": (
            ss.Problem(BLOCK, law, pull_rate=0.1, initial_excess=4.0, normal_load=Steps([0.0, 0.3], [10.0, 11.0])),
            1.5,
        ),
        "slab rests, normal load climbs": (ss.Problem(SLAB, COULOMB, **rests, normal_load=climbs), 14.0),
        "ageing, normal load steps": (
            ss.Problem(
                SLAB,
                AGEING,
                pull_rate=1.0,
                initial_load=6.3e7,
                initial_state=1e-2,
                normal_load=Steps([0.0, 1.0, 2.0], [1e8, 1.02e8, 0.99e8]),
            ),
            4.0,
        ),
        "ageing, normal load swings": (
            ss.Problem(BLOCK, AGEING, pull_rate=0.1, initial_load=6.2, initial_state=1.0, normal_load=Sinusoidal(10.0, 0.5, 0.7)),
            0.5,
        ),
        "two states": (
            ss.Problem(
                SLAB,
                friction.TwoStateRateAndState(0.6, 0.012, 0.01, 0.01, second_b=0.004, second_distance=0.1),
                pull_rate=1.0,
                initial_load=6.3e7,
                initial_state=1e-2,
                initial_second_state=1e-1,
            ),
            4.0,
        ),
        "bristles": (ss.Problem(BLOCK, friction.LuGre(0.7, 0.5, 0.1, 1e3, 5.0, 0.02), pull_rate=0.1, initial_load=0.0), 3.0),
        "lagged": (ss.Problem(SLAB, friction.LaggedFriction(friction.HyperbolicRate(0.8, 0.3, 0.1), 0.5), **slips), 4.0),
        "slab, pull steps": (ss.Problem(SLAB, law, pull_rate=Steps([0.0, 1.5, 6.0], [0.3, 0.5, 0.2]), initial_excess=1.5e7), 12.0),
        "far stress steps": (
            ss.Problem(soft, law, pull_rate=0.3, initial_excess=1.5e7, far_stress=Steps([0.0, 2.0], [7.6e7, 7.7e7])),
            12.0,
        ),
        "layers, pull steps": (ss.Problem(LAYERS, law, pull_rate=Steps([0.0, 1.5], [0.3, 0.5]), initial_excess=1.5e7), 12.0),
        "slab under a swinging pull": (ss.Problem(SLAB, law, pull_rate=pulls, initial_excess=1.5e7), 20.0),
        "soft driver, far stress": (
            ss.Problem(soft, law, pull_rate=0.3, initial_excess=1.5e7, far_stress=7.6e7, far_stress_rate=1e5),
            20.0,
        ),
        "soft driver, far stress swings": (
            ss.Problem(soft, law, pull_rate=0.3, initial_excess=1.5e7, far_stress=Sinusoidal(7.6e7, 1e6, 4.0)),
            20.0,
        ),
        "machine": (ss.Problem(replace(SLAB, **machine), law, **slips), 20.0),
        "driver changes": (ss.Problem(SLAB, law, **slips, far_stress=7.5e7, driver_reflection=freed), 20.0),
        "shaken slab": (ss.Problem(SLAB, law, **slips, ground_velocity=shakes), 15.0),
        "shaken slab with mass": (
            ss.Problem(replace(SLAB, contact_mass=1e6), law, **slips, ground_acceleration=Sinusoidal(0.0, 0.5, 2.0)),
            4.0,
        ),
        "shaken block": (
            ss.Problem(BLOCK, law, pull_rate=0.1, initial_excess=4.0, ground_acceleration=Sinusoidal(0.0, 0.5, 0.7)),
            1.5,
        ),
        "block with damping": (ss.Problem(replace(BLOCK, damping=0.5), law, pull_rate=pulls, initial_excess=4.0), 3.0),
        "layers": (ss.Problem(LAYERS, law, **slips), 20.0),
        "layers, normal load swings": (ss.Problem(LAYERS, law, **slips, normal_load=swings), 8.0),
        "shaken layers": (ss.Problem(LAYERS, law, **slips, ground_velocity=shakes), 20.0),
        "layers with drag": (ss.Problem(replace(LAYERS, drag=[20.0, 10.0], driver_impedance=3e6), law, **slips), 20.0),
        "layers, driver changes": (ss.Problem(LAYERS, law, **slips, far_stress=7.5e7, driver_reflection=freed), 20.0),
        "machine behind layers": (ss.Problem(replace(LAYERS, **machine), law, **slips), 20.0),
        "two slabs": (ss.Problem(ss.TwoSlabs([4e3], [2600.0], [3000.0], [6e3], [2800.0], [3500.0], 1e8), law, **slips), 20.0),
        "joined slabs": (
            ss.Problem(
                ss.TwoSlabs(
                    [4e3],
                    [2600.0],
                    [3000.0],
                    [6e3],
                    [2800.0],
                    [3500.0],
                    1e8,
                    sides="joined",
                    driver_impedance=3e6,
                    other_driver_impedance=4e6,
                ),
                law,
                **slips,
            ),
            20.0,
        ),
    }
    disc = ss.RotatingBlock(2.0, 20.0, 10.0, damping=0.1)
    found["rotating block"] = ss.Problem(disc, law, pull_rate=0.1, initial_excess=4.0), 1.5
    for name in ("drill-string", "pipe-and-collar", "reversing-axis"):
        one = ss.load_scenario(name)
        found[name] = one.problem, min(one.duration, 3.0)
    return found
