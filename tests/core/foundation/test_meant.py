"""A text that is no number with one unit is refused with the number that is probably meant, and signs of typesetters are read."""

import pytest

from stickslip.foundation.conversion import to_number
from stickslip.foundation.errors import InputError
from stickslip.foundation.meant import probably_meant
from stickslip.foundation.units import si_factor


@pytest.mark.parametrize(
    ("typed", "cure"),
    [
        ("10,5 km", "'10.5 km', with a decimal point"),
        ("10,500 m", "'10.500 m', with a decimal point, or '10500 m', without marks between digits"),
        ("1,234,500 m", "'1234500 m', without marks between digits"),
        ("10 000 m", "'10000 m', without marks between digits"),
        ("10'000 m", "'10000 m', without marks between digits"),
        ("10\u202f000.5 m", "'10000.5 m', without marks between digits"),
        ("6 1/8 in", "'6.125 in', without a fraction"),
        ('6-1/8"', "'6.125 in', without a fraction"),
        ("3/4 m", "'0.75 m', without a fraction"),
        ('6.125"', "'6.125 in', with the name of the unit"),
        ("20'", "'20 ft', with the name of the unit"),
        ("5' 6\"", "'5.5 ft', in one unit"),
        ("1 h 30 min", "'1.5 h', in one unit"),
    ],
)
def test_what_is_meant_is_said(typed: str, cure: str) -> None:
    with pytest.raises(InputError) as told:
        to_number(typed, "m")
    assert str(told.value).endswith(f": write {cure}")


@pytest.mark.parametrize("typed", ["ten km", "", "1 h 30", "5 m 3 kg", "1/0 m", "12:30", "10 20 m", "1" * 70 + ",5", "1/8/2 in"])
def test_nothing_is_guessed_of_other_texts(typed: str) -> None:
    assert probably_meant(typed) is None


@pytest.mark.parametrize(
    ("typed", "si", "number"),
    [
        ("100 N/mm²", "Pa", 1e8),
        ("10 μm", "m", 1e-5),
        ("\u22125 m s⁻¹", "m/s", -5.0),
        ("2 g/cm³", "kg/m^3", 2000.0),
        ("3 m·s⁻²", "m/s^2", 3.0),
    ],
)
def test_signs_of_typesetters_are_read(typed: str, si: str, number: float) -> None:
    assert to_number(typed, si) == pytest.approx(number, rel=1e-15)


@pytest.mark.parametrize("typed", ["10² m", "10⁻⁶ m", "10 m ²", "10 m⁰", "10 m¹²"])
def test_a_raised_number_that_is_no_power_of_a_unit_is_refused(typed: str) -> None:
    with pytest.raises(InputError):
        to_number(typed, "m")


def test_a_mass_where_a_force_is_asked_is_refused_with_its_weight() -> None:
    for unit, weight in (("kg", "kgf"), ("t", "tf"), ("tons", "tf")):
        with pytest.raises(InputError, match=f"^'{unit}' does not convert to N: it is a mass; a weight is in {weight}$"):
            si_factor(unit, "N")
    assert float(si_factor("tf", "N")) == 9806.65


def test_a_mil_is_a_length_where_an_angle_does_not_convert() -> None:
    assert float(si_factor("mil", "m")) == 25.4e-6
    assert float(si_factor("mils", "m")) == 25.4e-6


@pytest.mark.parametrize(("typed", "meant"), [("Km", "km"), ("Kpa", "kPa"), ("gPa", "GPa"), ("Mpa", "MPa"), ("Sec", "sec")])
def test_a_unit_in_letters_of_other_size_is_named(typed: str, meant: str) -> None:
    with pytest.raises(InputError, match=f"'{typed}' is not a unit; did you mean '{meant}'"):
        si_factor(typed, "m")
