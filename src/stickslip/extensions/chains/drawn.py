"""Numbers that are drawn for the blocks of a chain, by the name of a distribution and a seed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import CheckedArguments, check_whole, shown
from stickslip.foundation.conversion import to_number
from stickslip.foundation.errors import InputError, nearest

LARGEST_SEED = 2**63 - 1
Floats = NDArray[np.float64]


class Distribution(NamedTuple):
    """The numbers of a distribution by name, whether each is in the unit of the drawn ones, and how n numbers are drawn."""

    numbers: tuple[str, ...]
    has_unit: tuple[bool, ...]
    draw: Callable[[np.random.Generator, int, tuple[float, ...]], Floats]
    above: tuple[float, ...]
    """Lower bounds, exclusive, of the numbers."""


ANY = -np.inf
DISTRIBUTIONS = {
    "uniform": Distribution(
        ("low", "high"), (True, True), lambda source, n, p: p[0] + (p[1] - p[0]) * source.random(n), (ANY, ANY)
    ),
    "normal": Distribution(
        ("mean", "deviation"), (True, True), lambda source, n, p: p[0] + p[1] * source.standard_normal(n), (ANY, 0.0)
    ),
    "lognormal": Distribution(
        ("median", "sigma"), (True, False), lambda source, n, p: p[0] * np.exp(p[1] * source.standard_normal(n)), (0.0, 0.0)
    ),
    "weibull": Distribution(("scale", "shape"), (True, False), lambda source, n, p: p[0] * source.weibull(p[1], n), (0.0, 0.0)),
    "exponential": Distribution(("mean",), (True,), lambda source, n, p: p[0] * source.standard_exponential(n), (0.0,)),
}
"""The distributions by name: sigma is the deviation of the natural logarithm.

Low and high may be given either way round: the first belongs to a draw of 0.
"""


@dataclass(frozen=True, init=False)
class Drawn(CheckedArguments):
    """Numbers that are drawn, one for each block, from a distribution with a name and with a seed.

    The same distribution, numbers and seed give the same values (numpy's `default_rng`).

    Parameters
    ----------
    distribution : str
        "uniform" (low, high), "normal" (mean, deviation), "lognormal" (median, deviation of the natural logarithm), "weibull"
        (scale, shape) or "exponential" (mean).
    *numbers : float or str
        The numbers of the distribution, in this order, in SI or as texts with a unit.
    seed : int
        Seed of the draw, 0 or more.

    Examples
    --------
    >>> import stickslip as ss
    >>> ss.Drawn("uniform", "-1 mm", 0.0, seed=1).values(3, "m").round(6)
    array([-4.88e-04, -5.00e-05, -8.56e-04])
    """

    distribution: str
    numbers: tuple[Any, ...]
    seed: int

    def __init__(self, distribution: str, *numbers: Any, seed: int) -> None:
        found = DISTRIBUTIONS.get(distribution) if isinstance(distribution, str) else None
        if found is None:
            raise InputError(f"Drawn: distribution {shown(distribution)} is unknown; {nearest(str(distribution), DISTRIBUTIONS)}")
        if len(numbers) != len(found.numbers):
            raise InputError(f"Drawn: '{distribution}' takes {' and '.join(found.numbers)}, got {len(numbers)} numbers")
        object.__setattr__(self, "distribution", distribution)
        object.__setattr__(self, "numbers", tuple(numbers))
        object.__setattr__(self, "seed", check_whole("Drawn: seed", seed, 0, LARGEST_SEED))

    def in_unit(self, unit: str) -> tuple[float, ...]:
        """Return the numbers of the distribution as floats, where what is drawn has this unit (SI). Raises InputError."""
        kind = DISTRIBUTIONS[self.distribution]
        found = []
        for name, has_unit, above, given in zip(kind.numbers, kind.has_unit, kind.above, self.numbers, strict=True):
            own = unit if has_unit else "1"
            where = f"Drawn: {name} of '{self.distribution}' must be"
            try:
                number = to_number(given, own)
            except InputError as error:
                raise InputError(f"{where} a number{f' in {unit}' * has_unit}, got {error}") from None
            if not (np.isfinite(number) and (number > above or (name == "deviation" and number == 0.0))):
                raise InputError(f"{where} {'finite' if not np.isfinite(number) else f'above {above:g}'}, got {number:g}")
            found.append(float(number))
        return tuple(found)

    def values(self, count: int, unit: str) -> Floats:
        """Return numbers for so many blocks, in a unit (SI). Raises InputError if the numbers of the distribution do not fit it."""
        return DISTRIBUTIONS[self.distribution].draw(np.random.default_rng(self.seed), count, self.in_unit(unit))

    @property
    def text(self) -> str:
        """What is drawn, in words: "uniform (low -1 mm, high 0, seed 1)"."""
        names = DISTRIBUTIONS[self.distribution].numbers
        told = [
            f"{name} {given if isinstance(given, str) else format(given, 'g')}"
            for name, given in zip(names, self.numbers, strict=True)
        ]
        return f"{self.distribution} ({', '.join(told)}, seed {self.seed})"
