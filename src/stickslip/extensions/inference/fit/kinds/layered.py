"""What a fit asks of bodies of layers: their travel times are rounded to cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import cast

from stickslip.extensions.inference.fit.with_waves import FittedWaves
from stickslip.foundation.errors import InputError
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers


class _FittedLayered(FittedWaves):
    def rounded_times(self, body: BodyOnCharacteristics, names: Sequence[str]) -> list[str]:
        """Return a note if a travel time of layers is free. Raises InputError if several are: cells keep the ratios of the times.

        Between two values at which the cells change, the times of all layers grow alike: one time is told, and not its layer.
        """
        layers = cast(OfLayers, body)
        times = [name for name in names if any(f"{timed}[" in name for timed in layers.timed)]
        if not times:
            return []
        if len(times) > 1:
            raise InputError(
                f"infer: free: {' and '.join(times)} change travel times, which are rounded to cells:"
                f" free one of them, or {layers.untimed}"
            )
        error = layers.travel_time_error
        return [
            f"{times[0]} is fitted with travel times rounded to cells: its interval is that of the travel time of all"
            f" {layers.part}s together, and it may be {error:.2g} of itself further off, travel_time_error"
        ]


ANSWERS = _FittedLayered()
