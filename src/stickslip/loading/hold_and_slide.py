"""Define slides with holds between them, as in laboratory slide-hold-slide tests of how friction heals."""

from dataclasses import dataclass
from typing import ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number, Numbers
from stickslip.foundation.quantities import Quantity, Series, declare, quantity
from stickslip.loading.contract import VARYING, LoadingHistory, Segment


@dataclass(frozen=True)
class HoldAndSlide(LoadingHistory):
    """Slides of one duration at one value, with holds of given durations between them; the last slide lasts for ever."""

    kind = "hold-and-slide"
    source = "Dieterich 1972, J. Geophys. Res. 77, 3690-3697 (time-dependent friction in slide-hold-slide tests)"
    example: ClassVar = {"slide": 1e-6, "slide_time": "100 s", "hold_times": ["10 s", "100 s", "1000 s"]}

    slide: Number = quantity(VARYING, "value during a slide")
    slide_time: Number = quantity("s", "duration of the slide before each hold", above=0)
    hold_times: Numbers = declare(Series(Quantity("s", "duration of each hold", above=0), least=1))
    hold: Number = quantity(VARYING, "value during a hold", default=0.0)

    @property
    @override
    def segments(self) -> tuple[Segment, ...]:
        time, found = 0.0, [Segment(0.0, self.slide, 0.0)]
        for lasting in self.hold_times:
            begin = time + self.slide_time
            time = begin + lasting
            found += [Segment(begin, self.hold, 0.0), Segment(time, self.slide, 0.0)]
        return tuple(found)
