"""Central differences with friction that is regularised at small slip rates, as in codes that have no stick."""

from __future__ import annotations

from stickslip.schemes.central_differences import CentralDifferences


class Regularised(CentralDifferences):
    """Friction mu tanh(v/v0) with v0 = `smoothing` S (range of mu)/Z: the contact never sticks, but creeps.

    It tends to friction with stick as v0 tends to 0, not with the grid.
    """

    order = 0.0
    smoothing = 1e-3

    def __init__(self) -> None:
        super().__init__("regularised", "central differences, friction mu tanh(v/v0)", 0.8)
