"""What the explorer shows of uniform bodies with waves: both waves inside, sampled."""

from __future__ import annotations

from stickslip.extensions.explorer.model.answer import SlabPicture
from stickslip.extensions.explorer.model.pictures import energies_of_waves, slab_picture
from stickslip.extensions.explorer.model.sampled_waves import SampledWaves, ShownInterval
from stickslip.extensions.explorer.model.with_waves import ShownWaves
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError


class _ShownUniform(ShownWaves):
    def waves(self, shown: ShownInterval) -> SampledWaves | None:
        try:
            return SampledWaves(shown)
        except InputError:
            return None

    def inside(self, shown: ShownInterval, waves: SampledWaves | None) -> SlabPicture | None:
        return None if waves is None else slab_picture(waves)

    def energies(self, shown: ShownInterval, waves: SampledWaves | None, time: Floats) -> dict[str, Floats] | None:
        return None if waves is None else energies_of_waves(waves, time)


ANSWERS = _ShownUniform()
