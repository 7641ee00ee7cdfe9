"""The constants of a law's formulas, for many members."""

from __future__ import annotations

from stickslip.engine.codegen.compiler import ahead, call_prepare, floats, kernel
from stickslip.engine.state.layout import Floats, Integers


@kernel
def fill_constants(prepare: Integers, numbers: Floats, constants: Floats) -> None:
    """What `prepare` of each piece of the law says for each member; its numbers are the law's and the pieces' references."""
    members, pieces, size = constants.shape
    source, target, parameters = floats(numbers.ctypes.data), floats(constants.ctypes.data), numbers.shape[1] - pieces
    for n in range(members):
        for i in range(pieces):
            c, own = ahead(target, (n * pieces + i) * size), ahead(source, n * numbers.shape[1])
            call_prepare(prepare[i], own, own[parameters + i], c)
