"""Define loading histories: a pull rate or a far stress that varies in time.

To add one, add one file to this folder and its class to HISTORIES.
"""

from stickslip.loading.contract import LoadingHistory, Segment, Tone
from stickslip.loading.hold_and_slide import HoldAndSlide
from stickslip.loading.piecewise_linear import PiecewiseLinear
from stickslip.loading.sinusoidal import Sinusoidal
from stickslip.loading.steps import Steps

HISTORIES: dict[str, type[LoadingHistory]] = {
    history.kind: history for history in (PiecewiseLinear, Sinusoidal, Steps, HoldAndSlide)
}
"""Every built-in loading history by its name in scenario files."""

__all__ = ["HISTORIES", "HoldAndSlide", "LoadingHistory", "PiecewiseLinear", "Segment", "Sinusoidal", "Steps", "Tone"]
