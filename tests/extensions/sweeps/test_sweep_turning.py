"""Sweeps take a string and a disc, with their units."""

from __future__ import annotations

from itertools import product

import pytest

from tests.command_line import Command
from tests.core.cli.turning import SCENARIOS, TAKEN, check_turning

DOORS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "sweep": (("sweep", "--set", "duration=4 s", "-v", "pull_rate=20rpm..60rpm:2", "--figure", "a.png"), TAKEN, TAKEN),
    "one at a time": (("sweep", "--set", "duration=4 s", "-v", "static=0.7,0.8", "-q", "severity", "-q", "heat"), TAKEN, TAKEN),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("door", "body"), [*product(DOORS, SCENARIOS)])
def test_every_command_takes_what_turns_with_its_units_or_refuses_it_by_name(command: Command, door: str, body: str) -> None:
    words, of_string, of_disc = DOORS[door]
    of_sections = of_string.replace("TorsionalString", "SectionedString")
    check_turning(command, body, words, {"string": of_string, "sections": of_sections, "disc": of_disc}[body])
