"""Declared fields and texts with a unit: one set of rules for numbers and arrays, exact in SI, closed to anything else."""

from __future__ import annotations

import math
import random
import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import LARGEST, LARGEST_WHOLE, SMALLEST, Quantity, fields_of
from stickslip.foundation.units import (
    _TORQUES,
    COMMON_UNITS,
    SPELLINGS,
    TABLE_OF_UNITS,
    _looked_up,
    si_factor,
    split_quantity,
    tabulated,
    to_si,
)
from stickslip.friction import LAWS
from stickslip.problem.loading import HISTORIES


@pytest.mark.parametrize(
    ("number", "unit", "si", "expected"),
    [
        (10.0, "km", "m", 10_000.0),
        (0.05, "m/year", "m/s", 0.05 / 31_557_600),
        (5.0, "cm / yr", "m/s", 5.0 / 3_155_760_000),
        (100.0, "MPa", "Pa", 1e8),
        (2.8, "g/cm^3", "kg/m^3", 2800.0),
        (2.8, "g/cm3", "kg/m^3", 2800.0),
        (1.0, "foot3", "m^3", 0.028316846592),
        (9.8, "MPa s/m", "Pa s/m", 9.8e6),
        (9.8, "MPa*s/m", "Pa s/m", 9.8e6),
        (5.0, "/ m", "1/m", 5.0),
        (5.0, "m^-1", "1/m", 5.0),
        (343.0, "TN/m", "N/m", 3.43e14),
        (1.0, "kg*m/s**2", "N", 1.0),
        (480.0, "year", "s", 480 * 31_557_600.0),
        (1.0, "psi", "Pa", 6894.757293168362),
    ],
)
def test_converts_to_the_last_digit(number: float, unit: str, si: str, expected: float) -> None:
    assert to_si(number, unit, si) == pytest.approx(expected, rel=2.3e-16, abs=0)


@pytest.mark.parametrize(
    "text",
    [
        *(
            "",
            "km",
            "10",
            "ten km",
            "10 km km^",
            "10 m12",
            "10 2m",
            "10 m3kg",
            "10 m; import os",
            "__import__('os')",
            "10 m**99",
            "10 m^9999999",
            "1e9999 m",
        ),
        *(
            "10 (m)",
            "10 m+1",
            "10 m %",
            "nan m",
            "inf m",
            "10 m\n20 m",
            "10 " + "m*" * 40 + "m",
            "0x10 m",
            "10 m.__class__",
            "9**9**9",
        ),
    ],
)
def test_anything_else_is_no_quantity(text: str) -> None:
    assert split_quantity(text) is None


def test_a_number_too_large_for_a_float_is_infinite_and_left_to_the_range_check() -> None:
    assert split_quantity("1e999 m") == (float("inf"), "m")


@pytest.mark.parametrize(
    ("unit", "si", "message"),
    [
        ("kg", "m", "'kg' does not convert to m"),
        ("nan", "m", "'nan' is not a unit; write it like m"),
        ("parsnip", "m", "'parsnip' is not a unit; examples: km, s, year, kg, MPa, GN, kg/m^3, Pa s/m"),
        ("yaer", "s", "'yaer' is not a unit; did you mean 'year'?"),
        ("degC", "m", "'degC' does not convert to m"),
        ("dB/m", "1/m", "'decibel' is not a unit; examples: km, s, year, kg, MPa, GN, kg/m^3, Pa s/m"),
        ("octave", "1", "'octave' is not a unit; examples: km, s, year, kg, MPa, GN, kg/m^3, Pa s/m"),
    ],
)
def test_other_units_are_refused(unit: str, si: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        si_factor(unit, si)
    assert str(caught.value) == message


@pytest.mark.sampled(every=15)
@pytest.mark.parametrize("name", sorted(set(TABLE_OF_UNITS) - set(SPELLINGS) - {f"{prefix}Nm" for prefix in _TORQUES}))
def test_every_name_of_the_table_is_what_the_library_of_units_says(name: str) -> None:
    assert tabulated(name) == _looked_up(name, "")


def test_units_made_of_several_names_are_what_the_library_of_units_says() -> None:
    draw = random.Random(1)
    names = sorted(set(TABLE_OF_UNITS) - set(SPELLINGS) - {f"{prefix}Nm" for prefix in _TORQUES})
    for _ in range(500):
        factors = [draw.choice(names) + draw.choice(["", "", "^2", "**-1", " ^ 3", "^-9", "-2"]) for _ in range(draw.randint(1, 4))]
        unit = (
            draw.choice(["", "1/", "1/ "])
            + factors[0]
            + "".join(draw.choice([" ", "*", "/", " * ", " / ", ".", "·", "-"]) + one for one in factors[1:])
        )
        assert tabulated(unit) == _looked_up(unit, ""), unit


FEET = 0.3048
POUNDS = 4.4482216152605
"""Newtons in a pound-force."""


@pytest.mark.parametrize(
    ("written", "si", "expected"),
    [
        *((unit, "N m", 1.0) for unit in ("N.m", "N·m", "Nm", "N-m", "NM")),
        *((unit, "N m", 1000.0) for unit in ("kN.m", "kNm", "kN-m", "KNM", "KN.M", "kN m")),
        *((unit, "N m", 10.0) for unit in ("daNm", "daN.m", "DANM")),
        *((unit, "N m", FEET * POUNDS) for unit in ("ft-lbf", "ft.lbf", "FT-LBF", "ft-lb", "lb-ft", "FT.LBS", "ft lbf")),
        *((unit, "N m", 1000 * FEET * POUNDS) for unit in ("kft.lbf", "kft-lb", "klbf ft", "KFT-LBF")),
        *((unit, "N", 1000 * POUNDS) for unit in ("klbf", "klb", "klbs", "KLBF", "kip", "KIP")),
        *(
            (unit, "rad/s", math.pi / 30)
            for unit in ("rpm", "RPM", "rev/min", "r/min", "REV/MIN", "1/min", "min-1", "min^-1", "/min")
        ),
        *((unit, "m/s^2", 9.80665) for unit in ("g", "G", "g's")),
        *((unit, "m/s^2", 0.0980665) for unit in ("%g",)),
        *((unit, "m/s^2", 0.00980665) for unit in ("mg",)),
        *((unit, "m/s^2", 0.01) for unit in ("Gal", "gal", "cm/s/s", "cm.s-2", "cm s-2")),
        *((unit, "m/s^2", 1.0) for unit in ("m.s-2", "m s-2", "m/s/s", "m/s2", "M/S2")),
        *((unit, "m", 1e-6) for unit in ("mic", "mics", "micron", "microns")),
        *((unit, "Pa", 1e6) for unit in ("MPa", "MPA")),
        *((unit, "Pa", 6894.757293168362) for unit in ("psi", "PSI")),
    ],
)
def test_units_as_the_trades_write_them(written: str, si: str, expected: float) -> None:
    number, unit = split_quantity(f"2 {written.removeprefix('1')}") or (0.0, "")
    assert to_si(number, unit, si) == pytest.approx(2.0 * expected, rel=1e-15, abs=0)


def test_an_angle_in_a_unit_is_taken_at_its_word() -> None:
    assert to_si(60.0, "rad/min", "rad/s") == 1.0
    assert to_si(60.0, "/min", "1/s") == 1.0


@pytest.mark.parametrize(("unit", "si"), [("/min", "N m/rad"), ("min^-1", "s/rad"), ("kHz", "rad/s")])
def test_turns_and_radians_are_not_confused(unit: str, si: str) -> None:
    with pytest.raises(InputError, match="may be turns or radians per second: write rpm or rad/s"):
        si_factor(unit, si)


@pytest.mark.parametrize(("unit", "si"), [("mN", "N m"), ("lb", "Pa"), ("G", "m"), ("lb", "s"), ("ms-2", "m/s^2")])
def test_a_unit_that_does_not_fit_is_not_made_to(unit: str, si: str) -> None:
    with pytest.raises(InputError) as caught:
        si_factor(unit, si)
    assert str(caught.value) == f"'{unit}' does not convert to {si}"


@pytest.mark.parametrize("unit", COMMON_UNITS)
def test_common_units_need_no_library_of_units(unit: str) -> None:
    assert tabulated(unit) is not None


@pytest.mark.parametrize("unit", ["", "1", "m*", "* m", "m^10", "m^", "m//s", "m (s)", "parsnip", "mmHg", "km parsnip", "hbar"])
def test_the_table_leaves_all_else_to_the_library_of_units(unit: str) -> None:
    assert tabulated(unit) is None


def test_bundled_scenarios_are_read_without_the_library_of_units() -> None:
    code = (
        "import sys; from stickslip.problem.scenarios.library import names\n"
        "from stickslip.problem.scenarios.scenario import load_scenario\n"
        "for name in names(): load_scenario(name)\n"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_year_is_julian_everywhere() -> None:
    """365.25 days: in `ss.YEAR` and in texts with units."""
    assert ss.YEAR == 365.25 * 86_400.0
    assert si_factor("year", "s") == Fraction(31_557_600)
    assert to_si(1.0, "year", "s") == ss.YEAR


EDGES = (
    0.0,
    -0.0,
    1.0,
    1.5,
    SMALLEST,
    0.5 * SMALLEST,
    LARGEST,
    2.0 * LARGEST,
    LARGEST_WHOLE,
    LARGEST_WHOLE + 1.0,
    math.inf,
    math.nan,
)
NUMBERS = st.one_of(st.sampled_from([*EDGES, *(-edge for edge in EDGES)]), st.floats())
BOUNDS = st.sampled_from([None, 0.0, 1.0, -2.0])


@given(
    quantity=st.builds(
        Quantity, st.just("m"), st.just("length"), above=BOUNDS, at_least=BOUNDS, infinite=st.booleans(), whole=st.booleans()
    ),
    values=st.lists(NUMBERS, max_size=20),
)
def test_arrays_are_held_to_the_rules_of_single_numbers(quantity: Quantity, values: list[float]) -> None:
    def is_accepted(value: float) -> bool:
        try:
            return quantity.check("Owner", "field", value) == value
        except InputError:
            return False

    assert quantity.allows(np.array(values, float)).tolist() == [is_accepted(value) for value in values]


@pytest.mark.parametrize(
    ("quantity", "value", "message"),
    [
        (
            Quantity("m", ""),
            -(10**400),
            'must be a number in m or a text with a unit such as "10 m", got a whole number beyond 1e300',
        ),
        (Quantity("1", "", whole=True), 1.5, "must be a whole number up to 16, got 1.5"),
        (Quantity("1", "", above=0), 0.0, r"must be greater than 0 \(a pure number\), got 0"),
        (Quantity("m", "", at_least=1), 0.5, "must be at least 1 m, got 0.5"),
        (Quantity("m", ""), -1e60, r"must lie within 1e\+50 m, got -1e\+60"),
        (Quantity("m", "", above=0), 1e-60, "must be at least 1e-50 m, got 1e-60"),
    ],
)
def test_messages_say_where_what_and_what_is_allowed(quantity: Quantity, value: object, message: str) -> None:
    with pytest.raises(InputError, match=f"^Owner: field {message}$"):
        quantity.check("Owner", "field", value)


@pytest.mark.parametrize("kind", [*LAWS.values(), *HISTORIES.values()], ids=lambda kind: kind.kind)
def test_docstrings_list_every_field_and_the_source(kind: type) -> None:
    text = kind.__doc__ or ""
    section = text.partition("Parameters\n    ----------\n")[2]
    assert text.count("Parameters\n") == 1
    for name, (declared, _) in fields_of(kind).items():
        assert f"    {name}\n" in section
        assert declared.meaning[1:] in section
    assert kind.source in text  # type: ignore[attr-defined] # laws and histories have one
