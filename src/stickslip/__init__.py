"""stickslip: dynamic frictional sliding of a rigid block and of an elastic slab.

    import stickslip as ss
    slab = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=10e3, normal_stress=100e6)
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    problem = ss.Problem(slab, law, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)
    solution = ss.simulate(problem, duration=20.0)

All quantities are in SI units; compression is positive. Source: Campillo, Ionescu, Paumier, Renard 1996, Phys. Earth Planet.
Inter. 96.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from stickslip import friction, loading
from stickslip.bodies import ElasticSlab, SpringBlock
from stickslip.foundation.errors import InputError
from stickslip.problem import parameters
from stickslip.problem import selection_rule as selection
from stickslip.problem.problem import Problem

if TYPE_CHECKING:
    from stickslip.contact.critical import critical_value
    from stickslip.contact.uniqueness import uniqueness
    from stickslip.figures.sweeps.sweep import plot_sweep
    from stickslip.io.netcdf import load, save
    from stickslip.observables.statistics import catalogue_statistics
    from stickslip.run.catalogue import catalogue, resume_catalogue
    from stickslip.run.resume import resume
    from stickslip.run.simulate import simulate
    from stickslip.scenarios import load_scenario
    from stickslip.solution.solution import Solution
    from stickslip.studies.analogy import Analogy, analogy
    from stickslip.studies.compare import Comparison, compare
    from stickslip.studies.ensemble import Ensemble, ensemble
    from stickslip.studies.regularise import Regularisation, regularise
    from stickslip.sweeps.refine import refine
    from stickslip.sweeps.sweep import sweep

__version__ = "0.1.0"

YEAR = 31_557_600.0
"""Length of the Julian year, in s."""

_LATER = {
    "Analogy": "stickslip.studies.analogy",
    "Comparison": "stickslip.studies.compare",
    "Ensemble": "stickslip.studies.ensemble",
    "Regularisation": "stickslip.studies.regularise",
    "Solution": "stickslip.solution.solution",
    "analogy": "stickslip.studies.analogy",
    "catalogue": "stickslip.run.catalogue",
    "catalogue_statistics": "stickslip.observables.statistics",
    "compare": "stickslip.studies.compare",
    "critical_value": "stickslip.contact.critical",
    "ensemble": "stickslip.studies.ensemble",
    "load": "stickslip.io.netcdf",
    "load_scenario": "stickslip.scenarios",
    "plot_sweep": "stickslip.figures.sweeps.sweep",
    "predictability": "stickslip.observables.predictability",
    "refine": "stickslip.sweeps.refine",
    "regularise": "stickslip.studies.regularise",
    "resume": "stickslip.run.resume",
    "resume_catalogue": "stickslip.run.catalogue",
    "save": "stickslip.io.netcdf",
    "simulate": "stickslip.run.simulate",
    "sweep": "stickslip.sweeps.sweep",
    "uniqueness": "stickslip.contact.uniqueness",
}
"""Module of each public name that is imported on first use, because the compiler and the table libraries are slow to load."""

__all__ = [
    "YEAR",
    "Analogy",
    "Comparison",
    "ElasticSlab",
    "Ensemble",
    "InputError",
    "Problem",
    "Regularisation",
    "Solution",
    "SpringBlock",
    "analogy",
    "catalogue",
    "catalogue_statistics",
    "compare",
    "critical_value",
    "ensemble",
    "friction",
    "load",
    "load_scenario",
    "loading",
    "parameters",
    "plot_sweep",
    "predictability",
    "refine",
    "regularise",
    "resume",
    "resume_catalogue",
    "save",
    "selection",
    "simulate",
    "sweep",
    "uniqueness",
]


def __getattr__(name: str) -> Any:
    if name in _LATER:
        value = getattr(import_module(_LATER[name]), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module 'stickslip' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)
