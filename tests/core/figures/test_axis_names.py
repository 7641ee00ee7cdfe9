"""The names of axes can be read: a noun, its symbol, and a unit as people write it."""

from __future__ import annotations

import re

import pytest

from stickslip.figures.names import parameter_name, plain_name
from stickslip.figures.style import axis_text
from stickslip.foundation.names import for_readers
from stickslip.foundation.quantities import NumberSeries, Quantity, fields_of, quantities_of
from stickslip.friction import LAWS
from stickslip.problem.bodies import BODIES
from stickslip.problem.problem import Problem

LONGEST = 66
"""Largest number of letters in the name of an axis: two lines of a figure."""


def declared() -> list[tuple[str, str]]:
    """Every number that an axis may show: its place and what is declared of it."""
    kinds = [("body", one) for one in BODIES.values()] + [("friction", one) for one in LAWS.values()]
    found = [(f"{table}.{name}", entry) for table, kind in kinds for name, (entry, _) in fields_of(kind).items()]
    found += [(f"loading.{name}", entry) for name, entry in quantities_of(Problem).items()]
    numbers = [(name, entry.item if isinstance(entry, NumberSeries) else entry) for name, entry in found]
    return sorted({(name, entry.meaning) for name, entry in numbers if isinstance(entry, Quantity)})


@pytest.mark.parametrize(("name", "meaning"), declared())
def test_every_number_has_a_name_for_an_axis(name: str, meaning: str) -> None:
    text = parameter_name(name, meaning)
    words = re.sub(r"\$[^$]*\$", "", text).split()
    assert words, "a symbol alone says nothing"
    assert words[0] not in ("on", "in", "at", "by", "of", "the", "what", "whether")
    assert len(text) <= LONGEST
    assert " at which " not in text or not text.startswith("rate "), "a clause is no name"


@pytest.mark.parametrize(
    ("name", "shown", "plain"),
    [
        ("vw", "$v_{w}$", "vw"),
        ("mu0", r"$\mu_{0}$", "μ0"),
        ("tau_c", r"$\tau_{c}$", "τc"),
        ("Dc", "$D_{c}$", "Dc"),
        ("alpha", r"$\alpha$", "α"),
        ("wear", "wear", "wear"),
        ("weakening_rate", "weakening rate", "weakening rate"),
    ],
)
def test_numbers_of_a_formula_that_are_symbols_are_set_as_such(name: str, shown: str, plain: str) -> None:
    path = f"friction.parameters.{name}"
    assert (parameter_name(path, "values of the parameters"), plain_name(path, "")) == (shown, plain)


@pytest.mark.parametrize(
    ("unit", "readers"),
    [("m s^-1", "m/s"), ("kg m^-1 s^-2", "kg/(m s²)"), ("s^-1", "1/s"), ("m^2 s^-1", "m²/s"), ("N m rad-1", "N m/rad")],
)
def test_powers_of_units_are_written_as_people_do(unit: str, readers: str) -> None:
    assert for_readers(unit) == readers
    assert axis_text("rate", "v", unit) == f"rate $v$ ({readers})"
