from stickslip.extensions.strong_motion.record import record
from stickslip.problem.accelerogram import Accelerogram
from stickslip.problem.loading import HISTORIES, HoldAndSlide, PiecewiseLinear, Sinusoidal, Steps, Waypoints
from stickslip.problem.loading_history import VARYING, LoadingHistory, Segment, Tone

__all__ = [
    "HISTORIES",
    "VARYING",
    "Accelerogram",
    "HoldAndSlide",
    "LoadingHistory",
    "PiecewiseLinear",
    "Segment",
    "Sinusoidal",
    "Steps",
    "Tone",
    "Waypoints",
    "record",
]
