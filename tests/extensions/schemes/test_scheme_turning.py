"""Schemes refuse a string and a disc by name in one line."""

from __future__ import annotations

from itertools import product

import pytest

from tests.command_line import Command
from tests.core.cli.turning import SCENARIOS, check_turning

DOORS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "schemes": (
        ("schemes",),
        "schemes: TorsionalString has no grid: they are of an ElasticSlab",
        "schemes: RotatingBlock has no grid: they are of an ElasticSlab",
    ),
}


@pytest.mark.parametrize(("door", "body"), [*product(DOORS, SCENARIOS)])
def test_every_command_takes_what_turns_with_its_units_or_refuses_it_by_name(command: Command, door: str, body: str) -> None:
    words, of_string, of_disc = DOORS[door]
    of_sections = of_string.replace("TorsionalString", "SectionedString")
    check_turning(command, body, words, {"string": of_string, "sections": of_sections, "disc": of_disc}[body])
