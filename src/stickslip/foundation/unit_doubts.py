"""Doubts about columns without a unit in their heading."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.headings import KNOWN_COLUMNS, FoundColumn, HeadingColumn

LARGEST_VALUES: Mapping[str, float] = {"slip": 100.0, "slip_rate": 100.0, "load_point": 100.0, "load_rate": 100.0}
"""Largest values (SI) that no friction test reaches: beyond them the numbers are hardly in SI."""
OFTEN = {
    **{"m": "mm", "m/s": "mm/s", "m/s^2": "g", "s": "ms", "Pa": "MPa", "N": "kN", "N m": "kN m"},
    **{"rad": "deg", "rad/s": "rpm"},
}
"""Units that laboratories use in place of those of SI."""


def doubts_of(
    chosen: Mapping[str, FoundColumn], columns: Mapping[str, Floats], place: str, *, of_file: bool = True
) -> tuple[str, ...]:
    """Return a sentence, if any, on the columns without a unit that need one: those of a file, and others hardly in SI.

    Arrays in memory are in SI, unless another heading has a unit other than that, or their numbers are larger than any slip or slip
    rate. The ratio of two stresses needs no unit if both have none.
    """
    units = {name: found.unit for name, found in chosen.items()}
    if units.get("shear_stress", "") is units.get("normal_stress", "") is None:
        del units["shear_stress"], units["normal_stress"]
    sized = {name: unit for name, unit in units.items() if KNOWN_COLUMNS.get(name, HeadingColumn("1")).unit != "1"}
    foreign = any(chosen[name].factor != 1 for name in sized)
    bare = [name for name, unit in sized.items() if unit is None]
    if not of_file and not foreign:
        bare = [name for name in bare if np.max(np.abs(columns[name]), initial=0.0) > LARGEST_VALUES.get(name, math.inf)]
    return (f"{place}: {_bare(bare, chosen, of_file)}",) if bare else ()


def _bare(names: list[str], chosen: Mapping[str, FoundColumn], of_file: bool) -> str:
    """Return a sentence on columns without a unit: what they are read in, and how to say another."""
    first, *others = names
    units = {name: KNOWN_COLUMNS[name].unit for name in names}
    read = f"column {chosen[first].place + 1}, {first}, has no unit and is read in {units[first]}"
    read += "".join(f", and column {chosen[name].place + 1}, {name}, in {units[name]}" for name in others)
    often = OFTEN.get(units[first], units[first])
    cure = f"write {'them into the headings' if others else 'its unit into the heading'}, as in {first} ({often})"
    if of_file:
        cure += f', or name the column with it (--column, columns): {first}="{chosen[first].place + 1} ({often})"'
    return f"{read}; if {'they are in others' if others else 'it is in another'}, {cure}"
