"""Loading histories: a pull rate or a far stress that varies in time.

Adding one is one file beside these and one line in HISTORIES.
"""

from stickslip.loading.contract import LoadingHistory, Segment, Tone
from stickslip.loading.hold_and_slide import HoldAndSlide
from stickslip.loading.piecewise_linear import PiecewiseLinear
from stickslip.loading.sinusoidal import Sinusoidal
from stickslip.loading.steps import Steps

HISTORIES: dict[str, type[LoadingHistory]] = {
    history.kind: history for history in (PiecewiseLinear, Sinusoidal, Steps, HoldAndSlide)
}

__all__ = ["HISTORIES", "HoldAndSlide", "LoadingHistory", "PiecewiseLinear", "Segment", "Sinusoidal", "Steps", "Tone"]
