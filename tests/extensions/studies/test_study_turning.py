"""Studies take a string and a disc, with their units, or refuse them by name in one line."""

from __future__ import annotations

from itertools import product

import pytest

from tests.command_line import Command
from tests.core.cli.turning import SCENARIOS, SHORT, TAKEN, check_turning

DOORS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "compare": (("compare", "other.toml", *SHORT, "--out", "a.csv", "--figure", "a.png"), TAKEN, TAKEN),
    "analogy": (
        ("analogy", *SHORT, "--map", "static=0.7..0.8:2", "--map", "dynamic=0.4..0.5:2", "--figure", "a.png"),
        TAKEN,
        "analogy: needs a slab or a string: a block has no other block that stands for it",
    ),
    "ensemble": (("ensemble", *SHORT, "-m", "1"), TAKEN, TAKEN),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("door", "body"), [*product(DOORS, SCENARIOS)])
def test_every_command_takes_what_turns_with_its_units_or_refuses_it_by_name(command: Command, door: str, body: str) -> None:
    words, of_string, of_disc = DOORS[door]
    of_sections = of_string.replace("TorsionalString", "SectionedString")
    if door == "analogy":
        of_sections = "SectionedString: equivalent_block needs a rigid driver"
    check_turning(command, body, words, {"string": of_string, "sections": of_sections, "disc": of_disc}[body])
