# The public interface: what a user writes after `ss.`. These imports are carried out when a name is first used.

# What slides, what resists it, what drives it
# Many runs
from . import figures, friction, loading, studies
from .bodies import ElasticSlab, LayeredSlab, RotatingBlock, SectionedString, SpringBlock, TorsionalString, TwoSlabs
from .explorer.notebook import explore

# One run
from .foundation.constants import YEAR
from .foundation.errors import InputError
from .io.netcdf import open_solution
from .planar.slab import PlanarSlab
from .problem import Problem, selection
from .run.catalogue import catalogue
from .run.resume import resume
from .run.simulate import simulate
from .scenarios.scenario import load_scenario, scenarios
from .scenarios.source import uniqueness
from .solution.solution import Solution
from .sweeps.sweep import sweep

__version__: str

__all__ = [
    "YEAR",
    "ElasticSlab",
    "InputError",
    "LayeredSlab",
    "PlanarSlab",
    "Problem",
    "RotatingBlock",
    "SectionedString",
    "Solution",
    "SpringBlock",
    "TorsionalString",
    "TwoSlabs",
    "catalogue",
    "explore",
    "figures",
    "friction",
    "load_scenario",
    "loading",
    "open_solution",
    "resume",
    "scenarios",
    "selection",
    "simulate",
    "studies",
    "sweep",
    "uniqueness",
]
