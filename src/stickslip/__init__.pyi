# The public interface: what a user writes after `ss.`. These imports are carried out when a name is first used.

# What slides, what resists it, what drives it
# Many runs
from . import figures, friction, loading, studies
from .contact.uniqueness import uniqueness

# One run
from .extensions.chains.chain import Chain
from .extensions.chains.drawn import Drawn
from .extensions.explorer.notebook import explore
from .extensions.given_motion.moved import MovedContact
from .extensions.planar.slab import PlanarSlab
from .extensions.sweeps.sweep import sweep

# One run
from .foundation.constants import YEAR
from .foundation.errors import InputError
from .problem import Problem, selection
from .problem.bodies import (
    ElasticSlab,
    LayeredSlab,
    PositionLoop,
    RotaryLoop,
    RotatingBlock,
    SectionedString,
    SoilColumn,
    SpringBlock,
    TorsionalString,
    TwoSlabs,
)
from .problem.scenarios.scenario import load_scenario, scenarios
from .run.catalogue import catalogue
from .run.open_solution import open_solution
from .run.resume import resume
from .run.simulate import simulate
from .solution.solution import Solution

__version__: str

__all__ = [
    "YEAR",
    "Chain",
    "Drawn",
    "ElasticSlab",
    "InputError",
    "LayeredSlab",
    "MovedContact",
    "PlanarSlab",
    "PositionLoop",
    "Problem",
    "RotaryLoop",
    "RotatingBlock",
    "SectionedString",
    "SoilColumn",
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
