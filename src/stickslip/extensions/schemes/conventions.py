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
SIGN_AND_ZERO = "the opposite sign and another zero than the"
CONVENTIONS: dict[str, tuple[str, Callable[[Floats, Floats], Floats]]] = {
    "the opposite sign of the": ("multiply by -1", lambda own, exact: -own),
    "half of the": (SIDES, lambda own, exact: 2.0 * own),
    "twice the": ("divide by 2", lambda own, exact: 0.5 * own),
    ZERO: ("subtract", lambda own, exact: own - _zero(own, exact)),
    SIGN_AND_ZERO: ("multiply by -1 and then subtract", lambda own, exact: -own - _zero(-own, exact)),
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
            before, named = off(what, own), {said: off(what, change(own, exact)) for said, (_, change) in CONVENTIONS.items()}
            least = off(what, _scaled(own, exact))
            for said, sign in ((ZERO, 1.0), (SIGN_AND_ZERO, -1.0)):
                if what == "slip rate" or named[said] > least or (what == "slip" and not _begins_there(sign * own, exact)):
                    del named[said]
            best = min(named, key=lambda said: named[said] * (2.0 if said == SIGN_AND_ZERO else 1.0))  # a sign alone is simpler
            if before > 0.5 * tolerance and named[best] < EXPLAINS * before:
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
            if said in (ZERO, SIGN_AND_ZERO):
                sign = 1.0 if said == ZERO else -1.0
                zeros = (_zero(sign * self.pairs[what][0], self.pairs[what][1]) for what in names)
                cure += f" {' and '.join(brief(zero, unit_of(what), 4) for zero, what in zip(zeros, names, strict=True))}"
            yield f"{name} has {said} {right} {', '.join(names[:-1])}{' and ' if len(names) > 1 else ''}{names[-1]}: {cure}"


def _zero(own: Floats, exact: Floats) -> float:
    """Return the value that a series has where the exact one has 0."""
    return float(np.median(own - exact))


def _scaled(own: Floats, exact: Floats) -> Floats:
    """Return a series divided by its size in exact ones: a wrong size is no other zero."""
    size = float(np.dot(own, exact)) / (float(np.dot(exact, exact)) or 1.0)
    return own / (size or 1.0)


def _begins_there(own: Floats, exact: Floats) -> bool:
    """Return whether slip is off from the start on, as another zero is."""
    return abs(float(own[0] - exact[0])) > 0.5 * abs(_zero(own, exact))
