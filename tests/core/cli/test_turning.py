"""Every command takes a string and a disc, with their units, or refuses them by name in one line."""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import product
from pathlib import Path

import pytest

from tests.command_line import Outcome

DISC = """
title = "A turning disc"
[body]
kind = "rotating-block"
inertia = 1.0
stiffness = "100 N m/rad"
normal_torque = "10 N m"
damping = 1.0
[friction]
kind = "exponential-stribeck"
static = 0.8
dynamic = 0.5
rate = "10 rpm"
exponent = 1
[loading]
pull_rate = "10 rpm"
[initial]
load = 0.0
[run]
duration = "60 s"
"""
RECORD = "time (s),slip (mm),torque (N m)\n" + "".join(f"{n / 10},{n},{5 + n % 3}\n" for n in range(40))
SHORT = ("--duration", "2 s")
SLIDES = re.compile(r"(?<!N )\bm/s\b|\d[kMG]? ?Pa\b|\bslab\b|\bG/h\b|\bslip \(m\)")
"""What is said of contacts that slide."""
TAKEN = ""
"""In place of a refusal: the command takes the body."""

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
    "compare": (("compare", "other.toml", *SHORT, "--out", "a.csv", "--figure", "a.png"), TAKEN, TAKEN),
    "find": (("find", "--duration", "20 s", "--within", "0.1", "--figure", "a.png"), TAKEN, TAKEN),
    "sweep": (("sweep", "--set", "duration=4 s", "-v", "pull_rate=20rpm..60rpm:2", "--figure", "a.png"), TAKEN, TAKEN),
    "one at a time": (("sweep", "--set", "duration=4 s", "-v", "static=0.7,0.8", "-q", "severity", "-q", "heat"), TAKEN, TAKEN),
    "analogy": (
        ("analogy", *SHORT, "--map", "static=0.7..0.8:2", "--map", "dynamic=0.4..0.5:2", "--figure", "a.png"),
        TAKEN,
        "analogy: needs a slab or a string: a block has no other block that stands for it",
    ),
    "ensemble": (("ensemble", *SHORT, "-m", "1"), TAKEN, TAKEN),
    "schemes": (
        ("schemes",),
        "schemes: a TorsionalString has no grid: they are of an ElasticSlab",
        "schemes: a block has no grid: they are of an ElasticSlab",
    ),
    "infer": (
        ("infer", "record.csv", "--free", "static"),
        "record.csv: slip in m, where slip of a contact of TorsionalString is in rad",
        "record.csv: slip in m, where slip of a contact of RotatingBlock is in rad",
    ),
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
    "analogy": "SectionedString: equivalent_block needs a rigid driver",
    "lumps of events": "run: --shortest-event must be 0 or at most 0.0124593 s (1 % of the two-way travel time)",
}
"""What is said of a string of sections where it differs from what is said of a string of one."""
SCENARIOS = {"string": "drill-string", "sections": "pipe-and-collar", "disc": "disc.toml"}


LONG = {("run", "string"), ("field", "sections")}
"""Doors and bodies whose pictures take seconds: those of the other string are drawn in every run of the tests."""


@pytest.mark.parametrize(
    ("door", "body"),
    [pytest.param(*one, marks=pytest.mark.slow) if one in LONG else one for one in product(DOORS, SCENARIOS)],
)
def test_every_command_takes_what_turns_with_its_units_or_refuses_it_by_name(
    command: Callable[..., Outcome], door: str, body: str
) -> None:
    (name, *options), of_string, of_disc = DOORS[door]
    refusal = {
        "string": of_string,
        "sections": OF_SECTIONS.get(door, of_string.replace("TorsionalString", "SectionedString")),
        "disc": of_disc,
    }[body]
    Path("disc.toml").write_text(DISC, encoding="utf-8")
    Path("record.csv").write_text(RECORD, encoding="utf-8")
    scenario = SCENARIOS[body]
    Path("other.toml").write_text(DISC if body == "disc" else command("new", scenario).out, encoding="utf-8")
    shown = command(name, scenario, *options)
    if refusal:
        assert shown.refusal.startswith(refusal)
        return
    assert shown.code == 0, shown
    told = shown.out.replace("61 GPa", "").replace("7.93e+10 Pa", "") + "".join(
        one.read_text(encoding="utf-8") for one in Path().glob("a.csv")
    )
    assert not SLIDES.findall(told), told
    if "--catalogue" not in options:
        assert re.search(r"\brad\b|\bN m\b|\brpm\b|\b[kM]?J\b|\bstring over block\b", told)


def test_the_shell_sets_a_drive_by_one_word_and_check_says_its_three_numbers(command: Callable[..., Outcome]) -> None:
    said = " ".join(command("check", "drill-string", "--set", "soft_torque=5 s").out.split())
    for number in ("driver_impedance 498.25563 N m s", "driver_inertia 2900 kg m^2", "driver_integral_gain 4.5794964 kN m/rad"):
        assert number in said
    assert "T 5 s period to which the driver is tuned" in said
    assert "# soft_torque =" in command("new", "string").out
    refused = command("check", "drill-string", "--set", "soft_torque=soft").refusal
    assert refused == 'check: --set: soft_torque must be a period, as "5 s", or "impedance matched", got \'soft\'\n'
