"""Define laws whose friction differs with the direction of slip: two laws, one a way, and friction that presses its contact."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import LawField, declare, quantity
from stickslip.friction.contract import Formula
from stickslip.friction.formula.expression import Expression, Parameter
from stickslip.friction.law import FrictionLaw
from stickslip.friction.laws.combined import MAKES_LAWS, LawOfParts
from stickslip.friction.pressed import LawOnLaw

GAIN = Parameter("gain of friction on its normal load")
"""The gain in formulas, under a name that no parameter of a user's formula has."""


@dataclass(frozen=True)
class LawOfTwoWays(LawOfParts):
    """A law that is one law in forward slip and another in backward slip: the pieces of the first, then those of the second.

    What is asked without a direction, such as `coefficient`, is answered for forward slip; the second of `ways` for backward slip.
    """

    @property
    @abstractmethod
    @override
    def ways(self) -> tuple[FrictionLaw, FrictionLaw]:
        """The laws of forward and of backward slip, each with the slip rate's magnitude."""

    @property
    @override
    def backward_from(self) -> int:
        return len(self.ways[0].pieces)

    @override
    def check(self) -> None:
        name = type(self).__name__
        for place, part in self.parts.items():
            if not isinstance(part, FrictionLaw):
                raise InputError(f"{name}: {place} must be a friction law, got {type(part).__name__}; {MAKES_LAWS}")
            if part.states or not part.sticks:
                raise InputError(f"{name}: {place} must be a law that sticks and has no state of its own, {part.kind} is none")
            if part.backward_from:
                raise InputError(f"{name}: {place} must be the same in both directions of slip, {part.kind} is not")
            if part.memory != "all":
                raise InputError(f"{name}: {place} must remember all slip: leave memory = {part.memory!r} out of {part.kind}")

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return tuple(piece for way in self.ways for piece in way.pieces)

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        forward, backward = self.ways
        return (*forward.knots, math.inf, *backward.knots)

    @override
    def trees(self) -> tuple[Expression, ...]:
        return tuple(tree for way in self.ways for tree in way.trees())

    @override
    def parameters(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(name for way in self.ways for name in way.parameters()))

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        way, piece = self._way(i)
        own = way.numbers(piece)
        return tuple(own.get(name, 0.0) for name in self.parameters())

    @override
    def piece_coefficient(self, i: int, u: Any, v: Any, w: Any = 0.0) -> Any:
        way, piece = self._way(i)
        return way.piece_coefficient(piece, u, v, w)

    def _way(self, i: int) -> tuple[FrictionLaw, int]:
        """Return the law that has piece i, and which of its own pieces that is."""
        first = self.backward_from
        return (self.ways[1], i - first) if i >= first else (self.ways[0], i)

    @override
    def piece_at(self, u: ArrayLike, v: ArrayLike = 0.0) -> NDArray[np.intp]:
        return self.ways[0].piece_at(u, v)

    @override
    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Return mu as in `FrictionLaw.coefficient`, for forward slip."""
        return self.ways[0].coefficient(u, v, w)

    @property
    @override
    def static_excess(self) -> float:
        return self.ways[0].static_excess

    @override
    def range(self) -> tuple[float, float]:
        lows, highs = zip(*(way.range() for way in self.ways), strict=True)
        return min(lows), max(highs)

    @cached_property
    @override
    def depends_on_slip(self) -> bool:
        return any(way.depends_on_slip for way in self.ways)

    @cached_property
    @override
    def depends_on_rate(self) -> bool:
        return any(way.depends_on_rate for way in self.ways)

    @cached_property
    @override
    def variation(self) -> float:
        return max(way.variation for way in self.ways)

    @property
    @override
    def rate_scales(self) -> tuple[float, ...]:
        return tuple(dict.fromkeys(scale for way in self.ways for scale in way.rate_scales))

    @property
    @override
    def counts(self) -> Literal["net", "path"]:  # type: ignore[override] # follows the way that depends on slip
        return next((way for way in self.ways if way.depends_on_slip), self.ways[0]).counts

    @property
    @override
    def knot_variable(self) -> Literal["slip", "rate"]:  # type: ignore[override] # follows the way with knots
        return next((way for way in self.ways if way.knots), self.ways[0]).knot_variable


@dataclass(frozen=True)
class BothWays(LawOfTwoWays):
    """mu(u, v) is that of `forward` in forward slip and that of `backward` in backward slip.

    The contact rests between minus the static strength of `backward` and that of `forward`. Each law sees the magnitude of the slip
    rate; neither has a state, and if both depend on slip they count it alike.
    """

    kind = "both-ways"
    source = "the sources of its parts"
    example: ClassVar = {
        "forward": {"kind": "coulomb", "static": 0.6, "dynamic": 0.5},
        "backward": {"kind": "coulomb", "static": 0.4, "dynamic": 0.3},
    }

    forward: FrictionLaw = declare(LawField("a law for forward slip"))
    backward: FrictionLaw = declare(LawField("a law for backward slip"))

    @property
    @override
    def ways(self) -> tuple[FrictionLaw, FrictionLaw]:
        return self.forward, self.backward

    @override
    def check(self) -> None:
        super().check()
        forward, backward = self.ways
        if forward.depends_on_slip and backward.depends_on_slip and forward.counts != backward.counts:
            kinds = f"{forward.kind} counts {forward.counts} slip, {backward.kind} {backward.counts} slip"
            raise InputError(f"BothWays: forward and backward must count slip alike, but {kinds}")
        if forward.knots and backward.knots and forward.knot_variable != backward.knot_variable:
            kinds = f"{forward.kind} in {forward.knot_variable}, {backward.kind} in {backward.knot_variable}"
            raise InputError(f"BothWays: forward and backward must be piecewise in the same variable, but they are: {kinds}")


@dataclass(frozen=True)
class SelfEnergising(LawOfTwoWays):
    """Friction presses its own contact: S = S0 + gain tau, for a traction tau > 0 forwards.

    Then tau = S0 mu / (1 - gain mu) in forward slip and S0 mu / (1 + gain mu) in backward slip, for the mu of `law`: the leading
    and the trailing shoe of a brake, a wedge, a screw. S0 is the normal load of the body. Where gain mu reaches 1 no finite
    force slides the contact forwards (it jams: self-locking), and the law is refused; so it is backwards with a negative gain.
    A law that steps from static to sliding friction must not depend on slip.
    """

    kind = "self-energising"
    source = "Painleve 1895, C. R. Acad. Sci. 121, 112 (no solution, or several); Limpert 2011, Brake Design and Safety (shoes)"
    example: ClassVar = {"law": {"kind": "coulomb", "static": 0.45, "dynamic": 0.4}, "gain": 0.8}

    law: FrictionLaw = declare(LawField("a law of the coefficient under the whole normal load"))
    gain: float = quantity("1", "growth of the normal load per traction forwards")

    @cached_property
    @override
    def ways(self) -> tuple[FrictionLaw, FrictionLaw]:
        return EnergisedFriction(self.law, self.gain), EnergisedFriction(self.law, -self.gain)

    @override
    def check(self) -> None:
        super().check()
        if self.law.static_excess and self.law.depends_on_slip:
            raise InputError(f"SelfEnergising: a law with a step at rest must not depend on slip, {self.law.kind} does")
        most = self.law.range()[1]
        if abs(self.gain) * most < 1.0:
            return
        way, edge = ("forwards", "from 1 on") if self.gain > 0.0 else ("backwards", "from -1 down")
        jams = f"gain {self.gain:g} times friction {most:g} is {self.gain * most:.6g}, and {edge} the contact jams"
        allowed = f"gains between {-1.0 / most:.6g} and {1.0 / most:.6g} slide" if most < math.inf else "take a law with bounds"
        raise InputError(f"SelfEnergising: {jams}: no finite force slides it {way} (self-locking); {allowed}")

    @property
    @override
    def said_of_uniqueness(self) -> str:
        most = float(self.law.range()[1])
        if most == 0.0:
            return ""
        edge, way = (f"{1.0 / most:.6g} and more", "") if self.gain >= 0.0 else (f"{-1.0 / most:.6g} and less", " backwards")
        jams = f"at gains of {edge} the contact jams (self-locking): no finite force slides it{way}"
        return f" Friction presses the contact: {jams}; here gain = {self.gain:g}."


@dataclass(frozen=True)
class EnergisedFriction(LawOnLaw):
    """law / (1 - gain law): one way of `SelfEnergising`, which makes it; users never do."""

    kind = "energised"
    source = "see SelfEnergising"

    gain: float = 0.0

    def _energised(self, mu: Any) -> Any:
        return mu / (1.0 - self.gain * mu)

    @override
    def parameters(self) -> tuple[str, ...]:
        return (*self.law.parameters(), GAIN.name)

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        return (*self.law.piece_values(i), self.gain)

    @override
    def trees(self) -> tuple[Expression, ...]:
        made = {tree: tree / (1.0 - GAIN * tree) for tree in dict.fromkeys(self.law.trees())}
        return tuple(made[tree] for tree in self.law.trees())

    @override
    def piece_coefficient(self, i: int, u: Any, v: Any, w: Any = 0.0) -> Any:
        return self._energised(self.law.piece_coefficient(i, u, v, w))

    @override
    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Return mu as in `FrictionLaw.coefficient`, under the normal load that friction makes."""
        return np.asarray(self._energised(self.law.coefficient(u, v, w)))

    @property
    @override
    def static_excess(self) -> float:
        return float(self._energised(self.law.static_coefficient(0.0)) - self.coefficient(0.0)) if self.law.static_excess else 0.0

    @override
    def range(self) -> tuple[float, float]:
        low, high = self.law.range()
        return float(self._energised(low)), float(self._energised(high))
