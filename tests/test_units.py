"""Text with a unit to SI: exact, and closed to anything that is not a number with a unit."""

import random
import subprocess
import sys
from fractions import Fraction

import pytest

import stickslip as ss
from stickslip import InputError
from stickslip.foundation.units import COMMON_UNITS, UNITS, _looked_up, si_factor, split_quantity, tabulated, to_si


@pytest.mark.parametrize(
    ("number", "unit", "si", "expected"),
    [
        (10.0, "km", "m", 10_000.0),
        (0.05, "m/year", "m/s", 0.05 / 31_557_600),
        (5.0, "cm / yr", "m/s", 5.0 / 3_155_760_000),
        (100.0, "MPa", "Pa", 1e8),
        (2.8, "g/cm^3", "kg/m^3", 2800.0),
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


@pytest.mark.parametrize("unit", COMMON_UNITS)
def test_every_common_unit_is_one(unit: str) -> None:
    assert split_quantity(f"1.5 {unit}" if unit[0] != "1" else f"1.5 {unit[1:]}") is not None


@pytest.mark.parametrize(
    "text",
    [
        *("", "km", "10", "ten km", "10 km km^", "10 m; import os", "__import__('os')", "10 m**99", "10 m^9999999", "1e9999 m"),
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


@pytest.mark.parametrize("name", UNITS)
def test_every_name_of_the_table_is_what_the_library_of_units_says(name: str) -> None:
    assert tabulated(name) == _looked_up(name, "")


def test_units_made_of_several_names_are_what_the_library_of_units_says() -> None:
    draw = random.Random(1)
    names = list(UNITS)
    for _ in range(500):
        factors = [draw.choice(names) + draw.choice(["", "", "^2", "**-1", " ^ 3", "^-9"]) for _ in range(draw.randint(1, 4))]
        unit = (
            draw.choice(["", "1/", "1/ "])
            + factors[0]
            + "".join(draw.choice([" ", "*", "/", " * ", " / "]) + one for one in factors[1:])
        )
        assert tabulated(unit) == _looked_up(unit, ""), unit


@pytest.mark.parametrize("unit", COMMON_UNITS)
def test_common_units_need_no_library_of_units(unit: str) -> None:
    assert tabulated(unit) is not None


@pytest.mark.parametrize("unit", ["", "1", "m*", "* m", "m^10", "m^", "m//s", "m (s)", "parsnip", "psi", "km parsnip", "hbar"])
def test_the_table_leaves_all_else_to_the_library_of_units(unit: str) -> None:
    assert tabulated(unit) is None


def test_bundled_scenarios_are_read_without_the_library_of_units() -> None:
    code = (
        "import sys; from stickslip.scenarios.library import names; from stickslip.scenarios.scenario import load_scenario\n"
        "for name in names(): load_scenario(name)\n"
        "sys.exit('pint' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_a_year_is_julian_everywhere() -> None:
    """365.25 days: in `ss.YEAR` and in texts with units."""
    assert ss.YEAR == 365.25 * 86_400.0
    assert si_factor("year", "s") == Fraction(31_557_600)
    assert to_si(1.0, "year", "s") == ss.YEAR
