"""A string and a disc at every command: what turns is told in its units, or the command refuses it by name."""

from __future__ import annotations

import re
from pathlib import Path

from tests.command_line import Command

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
SCENARIOS = {"string": "drill-string", "sections": "pipe-and-collar", "disc": "disc.toml"}


def check_turning(command: Command, body: str, words: tuple[str, ...], refusal: str) -> None:
    """Fail unless a command takes the scenario of a body and speaks of it in its units, or refuses it as is said."""
    name, *options = words
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
