"""`compare --rules`: all selection rules in one table."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

import stickslip as ss
from tests.command_line import Command


def second(text: str) -> str:
    return text.splitlines()[1]


def test_all_selection_rules_are_one_table(command: Command, tmp_path: Path) -> None:
    """The waits are those of the four runs one by one: 468.805 years for rules that wait for the strength."""
    shown = command("compare", "second-event-maxwell", "--rules", "--out", "rules.csv")
    assert shown.code == 0
    rows = {
        line.split()[0]: line.split() for line in shown.out.splitlines() if re.match(r"(perfect|maxwell|minimal|maximal)", line)
    }
    table = pd.read_csv(tmp_path / "rules.csv", comment="#").set_index("name")
    assert list(rows) == list(table.index) == ["perfect-delay", "maxwell", "minimal", "maximal"]
    for rule in rows:
        run = ss.simulate(f"second-event-{rule}")
        wait = run.events.start[1] - run.events.end[0]
        assert table.wait[rule] == pytest.approx(wait, rel=1e-12, abs=0.0)
        assert float(rows[rule][1]) == pytest.approx(wait / ss.YEAR, rel=1e-5, abs=0.0)
        assert rows[rule][2] == "years"
        assert float(rows[rule][3]) == pytest.approx(run.events.slip[1], rel=1e-7, abs=0.0)
        assert table.end_slip[rule] == float(run.slip())
        assert rows[rule][-2:] == [str(len(run.events)), str(len(run.shocks))]
    assert "from 30.633498 m (maximal) to 46.880466 m (perfect-delay and minimal)" in second(shown.out)


def test_compare_says_the_last_number_in_its_second_line(command: Command) -> None:
    command("run", "reversing-axis", "--duration", "0.3 s", "--out", "a.nc")
    end = ss.simulate("reversing-axis", 0.3).reach.end
    both = command("compare", "a.nc", "a.nc").out
    assert second(both) == f"slip at the end {1e6 * end:.8g} um in all; largest displacement 631.4779 um in all"
