"""The constants of a law's formulas, for many members."""

from __future__ import annotations

from stickslip.evolution.compiled import ahead, call_prepare, floats, kernel
from stickslip.evolution.layout import Floats, Integers


@kernel
def fill_constants(prepare: Integers, numbers: Floats, references: Floats, constants: Floats) -> None:
    """What `prepare` of each piece of the law says for each member."""
    members, pieces, size = constants.shape
    source, target = floats(numbers.ctypes.data), floats(constants.ctypes.data)
    for n in range(members):
        for i in range(pieces):
            c = ahead(target, (n * pieces + i) * size)
            call_prepare(prepare[i], ahead(source, n * numbers.shape[1]), references[n, i], c)
