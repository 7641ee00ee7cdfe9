"""Inference from records under the names of studies: the room `stickslip.inference` does the work."""

from stickslip.inference.infer import infer
from stickslip.inference.inference import Inference, ranking
from stickslip.inference.record.record import Record

__all__ = ["Inference", "Record", "infer", "ranking"]
