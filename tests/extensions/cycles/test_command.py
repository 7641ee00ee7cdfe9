"""The command `stickslip cycle`, the figures, and what is printed of cycles and branches."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.cycles.edges import MEANING
from stickslip.figures.style import image
from tests.command_line import Command
from tests.extensions.cycles.problems import BRAKE, coulomb, rate_and_state, stribeck

pytestmark = pytest.mark.usefixtures("closed_figures")


def test_the_figure_of_a_cycle_has_one_period_and_the_phase_plane() -> None:
    for problem in (coulomb(), rate_and_state()):
        found = ss.studies.cycle(problem)
        figure = found.plot()
        rate, traction, plane = figure.axes
        assert image(figure, "png", 50.0)
        assert rate.lines[0].get_xdata()[-1] == pytest.approx(traction.lines[0].get_xdata()[-1])
        assert len(plane.lines[0].get_xdata()) == len(rate.lines[0].get_xdata())


@pytest.mark.slow
def test_the_figure_of_a_branch_is_dashed_where_it_is_unstable_and_marks_edges() -> None:
    branch = ss.studies.follow(ss.studies.cycle(stribeck(0.28, initial_load=0.0)), "pull_rate", to=0.35, steps=4)
    unstable = ss.studies.follow(ss.studies.cycle(stribeck(0.25, initial_load=0.0)), "pull_rate", to=0.35, steps=4)
    for one in (branch, unstable):
        amplitude, period = one.plot().axes
        looks = {line.get_label(): line.get_linestyle() for line in amplitude.lines}
        assert looks["stable"] == "-"
        assert looks["unstable"] == "--"
        assert "loss of stick" in looks
        assert len(period.lines) == len(amplitude.lines)


def test_the_command_finds_and_follows_a_cycle(tmp_path: Path, command: Command) -> None:
    file, table, figure = tmp_path / "brake.toml", tmp_path / "a.csv", tmp_path / "a.png"
    file.write_text(BRAKE, encoding="utf-8")
    given = "--along", "pull_rate", "--to", "0.35 m/s", "--steps", "4"
    done = command("cycle", str(file), *given, "--out", str(table), "--figure", str(figure))
    assert done.code == 0
    assert "A cycle of 0.199155157 s" in done.out
    assert "Loss of stick at loading.pull_rate = 0.3022214759 m/s" in done.out
    assert figure.stat().st_size > 0
    assert ["(mm/s)", "(ms)", "(mm/s)", "rest", "multiplier", "stable", "edge"] in [line.split() for line in done.out.splitlines()]
    assert ["302.221", "199.152"] in [line.split()[:2] for line in done.out.splitlines()], "all in the unit of the heading"
    rows = pd.read_csv(table, comment="#")
    assert rows["edge"].dropna().tolist()[0] == "loss of stick"
    assert rows["loading.pull_rate"][0] == 0.28
    assert command("cycle", str(file), "--out", str(table)).code == 0
    assert len(pd.read_csv(table, comment="#")) == 1


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("--along", "pull_rate"), "cycle: --along needs --to"),
        (("--to", "1"), "cycle: --to needs --along"),
        (("--along", "pul_rate", "--to", "1"), "follow: 'pul_rate' is not a parameter of this scenario; did you mean 'pull_rate'"),
        (("--near", "-1 s"), "cycle: near must be"),
    ],
)
def test_the_command_says_what_is_wrong(given: tuple[str, ...], said: str, tmp_path: Path, command: Command) -> None:
    file = tmp_path / "brake.toml"
    file.write_text(BRAKE, encoding="utf-8")
    assert command("cycle", str(file), *given).refusal.startswith(said)


def test_the_page_has_a_row_for_each_edge_that_a_branch_may_name() -> None:
    page = (Path(__file__).parents[3] / "docs" / "cycles.md").read_text(encoding="utf-8")
    _, _, rows = page.partition("| edge | what happens there |")
    table, _, _ = rows.partition("\n\n")
    assert {row.split(" | ")[0].removeprefix("| ") for row in table.splitlines()[2:]} == set(MEANING)
