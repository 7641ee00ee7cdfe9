from .analogy import Analogy, analogy
from .compare import Comparison, compare
from .ensemble import Ensemble, ensemble
from .one_run import catalogue_statistics, critical_value, predictability
from .regularise import Regularisation, regularise

__all__ = [
    "Analogy",
    "Comparison",
    "Ensemble",
    "Regularisation",
    "analogy",
    "catalogue_statistics",
    "compare",
    "critical_value",
    "ensemble",
    "predictability",
    "regularise",
]
