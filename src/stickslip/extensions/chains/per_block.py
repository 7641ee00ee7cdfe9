"""Numbers of the blocks of a chain in a scenario file: one for all, a list, or drawn from a distribution that is named."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import MISSING
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from stickslip.extensions.chains.chain import MOST_BLOCKS, OF_BLOCKS
from stickslip.extensions.chains.couplings import SPRING, is_sparse
from stickslip.extensions.chains.drawn import DISTRIBUTIONS, LARGEST_SEED, Drawn
from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.given import Given
from stickslip.foundation.quantities import LARGEST_SERIES, NumberSeries, Quantity

DRAWN_KEY, SEED_KEY = "drawn", "seed"
"""The keys of a table of numbers that are drawn: the name of their distribution, and the seed."""
EXAMPLE = '{ drawn = "uniform", low = 9.0, high = 11.0, seed = 1 }'
COUNT_OF_BLOCKS = Quantity("1", "number of blocks, or of rows or columns of a lattice", at_least=1, at_most=MOST_BLOCKS)
SEED = Quantity("1", "seed of the numbers that are drawn", at_least=0, at_most=float(LARGEST_SEED))
COUPLING = "coupling"
NOT_DRAWN = (COUPLING,)
"""The numbers that are not drawn."""
OPTIONAL = ("damping", "initial_slip")
"""The numbers that are 0 if they are left out."""
ORDER = ("mass", COUPLING, "stiffness", "normal_force", *OPTIONAL)


class OfBlocks(NamedTuple):
    """The declaration of a number of blocks, or springs, and its default: MISSING if it must be given."""

    declared: Quantity
    default: Any


@cache
def of_blocks() -> Mapping[str, OfBlocks]:
    """Return the numbers of blocks by their keys in a file."""
    declared = {**OF_BLOCKS, COUPLING: SPRING}
    return {name: OfBlocks(declared[name], 0.0 if name in OPTIONAL else MISSING) for name in ORDER}


def read_blocks(value: Any, place: Any) -> int | tuple[int, int]:
    """Return the number of blocks, or rows and columns of a lattice. Raises InputError."""
    counts = value if isinstance(value, list) and len(value) == 2 else [value]
    if not all(isinstance(one, int) and not isinstance(one, bool) and one >= 1 for one in counts):
        raise InputError(
            f"{place.source.file}: {place} must be a whole number, or [rows, columns] of a lattice, got {shown(value)}"
        )
    if (many := counts[0] * (counts[1] if len(counts) == 2 else 1)) > (most := min(MOST_BLOCKS, place.source.most_nodes)):
        raise InputError(f"{place.source.file}: {place} must be at most {most:.0f} in all, got {shown(many)}")
    return counts[0] if len(counts) == 1 else (counts[0], counts[1])


def read_numbers(declared: Quantity, value: Any, place: Any) -> Any:
    """Return one number for all blocks, a tuple of one each, or what is drawn, in SI. Raises InputError."""
    if isinstance(value, dict):
        return _read_drawn(declared, value, place)
    if not isinstance(value, list):
        return declared.check(place.source.file, str(place), value)
    if not value:
        raise InputError(f"{place.source.file}: {place} must have one number for each block or spring, got an empty list")
    found = NumberSeries(declared).at_once(value)
    return found or tuple(declared.check(place.source.file, f"{place}[{i}]", one) for i, one in enumerate(value))


def _read_drawn(declared: Quantity, table: Mapping[str, Any], place: Any) -> Drawn:
    """Return what a table such as EXAMPLE says is drawn. Raises InputError."""
    where, kind = f"{place.source.file}: {place}", table.get(DRAWN_KEY)
    if place.key in NOT_DRAWN:
        raise InputError(f"{where} must be a number, or a list of one for each spring: it is not drawn")
    if kind is None:
        raise InputError(f"{where} must say how its numbers are drawn, as {EXAMPLE}")
    if not isinstance(kind, str) or kind not in DISTRIBUTIONS:
        raise InputError(f"{where} {DRAWN_KEY} {shown(kind)} is unknown; {nearest(str(kind), DISTRIBUTIONS)}")
    numbers = _numbers_of(kind, declared)
    allowed = (DRAWN_KEY, *numbers, SEED_KEY)
    for key in table:
        if key not in allowed:
            raise InputError(f"{where} {shown(key)} is unknown; {nearest(key, allowed)}")
    if missing := next((key for key in allowed if key not in table), None):
        raise InputError(f"{where} {missing} is missing: {kind} has {', '.join(numbers)} and {SEED_KEY}")
    given = [one.check(place.source.file, f"{place} {name}", table[name]) for name, one in numbers.items()]
    seed = table[SEED_KEY]
    if not isinstance(seed, int) or isinstance(seed, bool) or not 0 <= seed <= LARGEST_SEED:
        raise InputError(f"{where} {SEED_KEY} must be a whole number from 0 to {LARGEST_SEED}, got {shown(seed)}")
    drawn = Drawn(kind, *given, seed=seed)
    try:
        _ = drawn.in_unit(declared.unit)
    except InputError as error:
        raise InputError(f"{where} {str(error).removeprefix('Drawn: ')}") from None
    return drawn


def _numbers_of(kind: str, declared: Quantity) -> dict[str, Quantity]:
    """Return the numbers of a distribution by name, where what is drawn is declared in this way."""
    made = DISTRIBUTIONS[kind]
    units = (declared.unit if has_unit else "1" for has_unit in made.has_unit)
    return {name: Quantity(unit, f"{name} of the distribution") for name, unit in zip(made.numbers, units, strict=True)}


def written(value: Any) -> Any:
    """Return what a file says of a number of blocks, or of any other key of [chain]."""
    if isinstance(value, Drawn):
        names = DISTRIBUTIONS[value.distribution].numbers
        return {DRAWN_KEY: value.distribution, **dict(zip(names, map(written, value.numbers), strict=True)), SEED_KEY: value.seed}
    if isinstance(value, tuple):
        return [written(one) for one in value]
    return value.text if isinstance(value, Given) else value


def numbers_in(name: str, declared: Quantity, value: Any) -> Iterator[tuple[str, Quantity]]:
    """Yield the parameters in a number of blocks, by their places in [chain]: itself, those of a list, or those that draw it."""
    if isinstance(value, Drawn):
        yield from ((f"{name}.{one}", entry) for one, entry in _numbers_of(value.distribution, declared).items())
        yield f"{name}.{SEED_KEY}", SEED
    elif isinstance(value, tuple):
        yield from ((f"{name}[{i}]", declared) for i in range(len(value) if len(value) <= LARGEST_SERIES else 0))
    else:
        yield name, declared


def as_given(name: str, value: Any) -> Any:
    """Return a number of the blocks of a chain as a scenario has it. Raises InputError for one that a file cannot say."""
    if is_sparse(value):
        raise InputError(f"Chain: {name} is a matrix, which no scenario file can say")
    if isinstance(value, Drawn):
        numbers = _numbers_of(value.distribution, of_blocks()[name].declared)
        given = [one.check("Drawn", key, number) for (key, one), number in zip(numbers.items(), value.numbers, strict=True)]
        return Drawn(value.distribution, *given, seed=value.seed)
    return tuple(value.tolist()) if isinstance(value, np.ndarray) else value
