from stickslip.contact import critical_value
from stickslip.extensions.chains.beside_slab import ChainBesideSlab, chain_beside_slab
from stickslip.extensions.chains.magnitudes import magnitudes
from stickslip.extensions.chains.statistics import GutenbergRichter, gutenberg_richter
from stickslip.extensions.cycles.branch import BranchOfCycles
from stickslip.extensions.cycles.exponent import LyapunovExponent
from stickslip.extensions.cycles.find_cycle import cycle
from stickslip.extensions.cycles.follow import follow
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.lyapunov import lyapunov
from stickslip.extensions.given_motion.identification import Identification
from stickslip.extensions.given_motion.identify import identify
from stickslip.extensions.inference.infer import infer
from stickslip.extensions.inference.inference import Inference, ranking
from stickslip.extensions.inference.record.record import Record
from stickslip.extensions.schemes.benchmarks import judge_series
from stickslip.extensions.schemes.schemes import Schemes, schemes
from stickslip.extensions.sensitivity.result import Sensitivity
from stickslip.extensions.sensitivity.study import sensitivity
from stickslip.extensions.strong_motion.displacements import SlidingDisplacements
from stickslip.extensions.strong_motion.sliding import sliding
from stickslip.extensions.studies.analogy import Analogy, analogy
from stickslip.extensions.studies.compare import Comparison, compare
from stickslip.extensions.studies.ensemble import Ensemble, ensemble
from stickslip.run.find import Edge, find
from stickslip.run.one_run import steady
from stickslip.solution.observables import catalogue_statistics
from stickslip.solution.observables.predictability import predictability
from stickslip.solution.observables.severity import severity

__all__ = [
    "Analogy",
    "BranchOfCycles",
    "ChainBesideSlab",
    "Comparison",
    "Edge",
    "Ensemble",
    "GutenbergRichter",
    "Identification",
    "Inference",
    "LimitCycle",
    "LyapunovExponent",
    "Record",
    "Schemes",
    "Sensitivity",
    "SlidingDisplacements",
    "analogy",
    "catalogue_statistics",
    "chain_beside_slab",
    "compare",
    "critical_value",
    "cycle",
    "ensemble",
    "find",
    "follow",
    "gutenberg_richter",
    "identify",
    "infer",
    "judge_series",
    "lyapunov",
    "magnitudes",
    "predictability",
    "ranking",
    "schemes",
    "sensitivity",
    "severity",
    "sliding",
    "steady",
]
