"""Every command takes a string and a disc, with their units, or refuses them by name in one line."""

from __future__ import annotations

from itertools import product

import pytest

from tests.command_line import Command
from tests.core.cli.turning import SCENARIOS, SHORT, TAKEN, check_turning

DOORS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "check": (("check",), TAKEN, TAKEN),
    "run": (("run", *SHORT, "--out", "run.nc", "--figure", "a.png", "--energy-figure", "b.png"), TAKEN, TAKEN),
    "friction over slip": (("run", *SHORT, "--friction-figure", "a.png"), TAKEN, TAKEN),
    "catalogue": (("run", *SHORT, "--catalogue", "a.csv", "--catalogue-figure", "a.png"), TAKEN, TAKEN),
    "field": (("run", *SHORT, "--space-time", "a.png"), TAKEN, "run: --space-time needs a slab or a string: a block is rigid"),
    "path": (
        ("run", "--path", "a.png"),
        "run: --path needs a slab or a string without a mass at its contact",
        "run: --path needs a slab or a string without a mass at its contact",
    ),
    "export": (
        ("export", "a.txt"),
        "export: the layout of the SCEC has slip in m and stress in MPa, a contact that turns (TorsionalString) has neither",
        "export: the layout of the SCEC has slip in m and stress in MPa, a contact that turns (RotatingBlock) has neither",
    ),
    "find": (("find", "--duration", "20 s", "--within", "0.1", "--figure", "a.png"), TAKEN, TAKEN),
    "lumps of events": (
        ("run", "--shortest-event", "1 s"),
        "run: --shortest-event must be 0 or at most 0.0126991 s (1 % of the two-way travel time)",
        "run: --shortest-event must be 0 here: only with waves and a rigid driver",
    ),
    "one way": (("run", *SHORT, "--set", "one_way=true"), TAKEN, TAKEN),
    "metres": (
        ("run", "--set", "initial.slip=1 m"),
        "run: --set: initial.slip must be a number in rad or a text with a unit",
        "run: --set: initial.slip must be a number in rad or a text with a unit",
    ),
}

OF_SECTIONS = {
    "path": TAKEN,
    "lumps of events": "run: --shortest-event must be 0 or at most 0.0124593 s (1 % of the two-way travel time)",
}
"""What is said of a string of sections where it differs from what is said of a string of one."""


LONG = {("run", "string"), ("field", "sections")}
"""Doors and bodies whose pictures take seconds: those of the other string are drawn in every run of the tests."""


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize(
    ("door", "body"),
    [pytest.param(*one, marks=pytest.mark.slow) if one in LONG else one for one in product(DOORS, SCENARIOS)],
)
def test_every_command_takes_what_turns_with_its_units_or_refuses_it_by_name(command: Command, door: str, body: str) -> None:
    words, of_string, of_disc = DOORS[door]
    of_sections = OF_SECTIONS.get(door, of_string.replace("TorsionalString", "SectionedString"))
    check_turning(command, body, words, {"string": of_string, "sections": of_sections, "disc": of_disc}[body])


def test_the_shell_sets_a_drive_by_one_word_and_check_says_its_three_numbers(command: Command) -> None:
    said = " ".join(command("check", "drill-string", "--set", "soft_torque=5 s").out.split())
    for number in ("driver_impedance 498.25563 N m s", "driver_inertia 2900 kg m^2", "driver_integral_gain 4.5794964 kN m/rad"):
        assert number in said
    assert "T 5 s period to which the driver is tuned" in said
    assert "# soft_torque =" in command("new", "string").out
    refused = command("check", "drill-string", "--set", "soft_torque=soft").refusal
    assert refused == 'check: --set: soft_torque must be a period, as "5 s", or "impedance matched", got \'soft\'\n'
