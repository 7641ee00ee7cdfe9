"""Calculate the constants of a law's formulas for many members."""

from __future__ import annotations

from stickslip.engine.codegen.compiler import ahead, call_prepare, floats, kernel
from stickslip.engine.state.layout import Floats, Integers


@kernel
def fill_constants(prepare: Integers, numbers: Floats, constants: Floats) -> None:
    """Call `prepare` of each piece of the law for each member, to fill `constants`, of shape (members, pieces, size).

    prepare holds the addresses of these functions. A row of `numbers` has the law's parameters and the reference slip (m) of each
    piece.
    """
    members, pieces, size = constants.shape
    source, target, parameters = floats(numbers.ctypes.data), floats(constants.ctypes.data), numbers.shape[1] - pieces
    for n in range(members):
        for i in range(pieces):
            c, own = ahead(target, (n * pieces + i) * size), ahead(source, n * numbers.shape[1])
            call_prepare(prepare[i], own, own[parameters + i], c)
