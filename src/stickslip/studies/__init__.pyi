from .analogy import Analogy, analogy
from .benchmarks import judge_series
from .compare import Comparison, compare
from .ensemble import Ensemble, ensemble
from .find import Edge, find
from .inference import Inference, Record, infer, ranking
from .one_run import catalogue_statistics, critical_value, predictability, severity, steady
from .schemes import Schemes, schemes

__all__ = [
    "Analogy",
    "Comparison",
    "Edge",
    "Ensemble",
    "Inference",
    "Record",
    "Schemes",
    "analogy",
    "catalogue_statistics",
    "compare",
    "critical_value",
    "ensemble",
    "find",
    "infer",
    "judge_series",
    "predictability",
    "ranking",
    "schemes",
    "severity",
    "steady",
]
