"""Other conventions that a right series may be written in: signs, halves, and zeros."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief

EXPLAINS = 0.2
"""Name a cause if it lessens the distance from the exact series by this factor."""
SIDES = "of two elastic sides each slips by half, and the jump between them counts"
ZERO = "another zero than the"
CONVENTIONS: dict[str, tuple[str, Callable[[Floats, Floats], Floats]]] = {
    "the opposite sign of the": ("multiply by -1", lambda own, exact: -own),
    "half of the": (SIDES, lambda own, exact: 2.0 * own),
    "twice the": ("divide by 2", lambda own, exact: 0.5 * own),
    ZERO: ("subtract", lambda own, exact: own - float(np.median(own - exact))),
}
"""A right series may be written in other conventions: what it then has, the cure, and the series in the convention used here."""


@dataclass(frozen=True)
class Written:
    """The conventions that a series is written in: `found` has the quantities of each, of `pairs` of own and exact values."""

    pairs: Mapping[str, tuple[Floats, Floats]]
    found: Mapping[str, list[str]] = field(default_factory=dict)

    @classmethod
    def of(cls, pairs: Mapping[str, tuple[Floats, Floats]], off: Callable[[str, Floats], float], tolerance: float) -> Written:
        """Return the conventions that explain what is off; `off` returns the share that values of a quantity are off by."""
        found: dict[str, list[str]] = {}
        for what, (own, exact) in pairs.items():
            named = {said: off(what, change(own, exact)) for said, (_, change) in CONVENTIONS.items()}
            best, before = min(named, key=lambda said: named[said]), off(what, own)
            if before > 0.5 * tolerance and named[best] < EXPLAINS * before and (what, best) != ("slip rate", ZERO):
                found.setdefault(best, []).append(what)
        return cls(pairs, found)

    @property
    def mended(self) -> dict[str, Floats]:
        """Each quantity in the convention used here."""
        values = {what: own for what, (own, _) in self.pairs.items()}
        return values | {what: CONVENTIONS[said][1](*self.pairs[what]) for said, names in self.found.items() for what in names}

    def sentences(self, name: str, right: str, unit_of: Callable[[str], str]) -> Iterator[str]:
        """Yield a sentence for each convention of a series of this name beside one that is `right`, as "exact"."""
        for said, names in self.found.items():
            cure = CONVENTIONS[said][0]
            if said == ZERO:
                zeros = (brief(float(np.median(np.subtract(*self.pairs[what]))), unit_of(what), 4) for what in names)
                cure = f"subtract {' and '.join(zeros)}"
            yield f"{name} has {said} {right} {', '.join(names[:-1])}{' and ' if len(names) > 1 else ''}{names[-1]}: {cure}"
