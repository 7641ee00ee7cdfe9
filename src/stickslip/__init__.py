"""stickslip: dynamic frictional sliding of a rigid block and of an elastic slab.

    import stickslip as ss
    slab = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=10e3, normal_stress=100e6)
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    problem = ss.Problem(slab, law, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)
    solution = ss.simulate(problem, duration=20.0)
    solution.plot()

All quantities are in SI units; compression is positive. Source: Campillo, Ionescu, Paumier, Renard 1996, Phys. Earth Planet.
Inter. 96.

`__init__.pyi` lists the public names on one page. Each is imported when it is first used, because the compiler and the table
libraries are slow to load.
"""

from stickslip.foundation.lazy_names import lazy_names

__version__ = "0.1.0"

__getattr__, __dir__ = lazy_names(__name__, __file__)
