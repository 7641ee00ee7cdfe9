from .analogy import Analogy, analogy
from .compare import Comparison, compare
from .ensemble import Ensemble, ensemble
from .inference.infer import infer, ranking
from .inference.inference import Inference
from .inference.record import Record
from .one_run import catalogue_statistics, critical_value, predictability
from .regularise import Regularisation, regularise

__all__ = [
    "Analogy",
    "Comparison",
    "Ensemble",
    "Inference",
    "Record",
    "Regularisation",
    "analogy",
    "catalogue_statistics",
    "compare",
    "critical_value",
    "ensemble",
    "infer",
    "predictability",
    "ranking",
    "regularise",
]
