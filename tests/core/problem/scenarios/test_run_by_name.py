"""Scenarios by name or file as the first argument: the scenario's options, those given in their place, and the list of names."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import stickslip as ss
from stickslip.problem.scenarios.library import entries, names, text
from stickslip.solution.solution import Solution

OPTIONS = """
[run]
duration = "3 s"
rtol = 1e-8
events = 4
shortest_event = "1 ms"
"""


@pytest.fixture(name="file")
def _file(tmp_path: Path) -> Path:
    """Return a file with the slab of Fig. 6 and options that differ from all defaults."""
    path = tmp_path / "mine.toml"
    path.write_text(text("fig6-slab").partition("[run]")[0] + OPTIONS, encoding="utf-8")
    return path


def options_of(run: Solution) -> tuple[float, float, int | None, float | None]:
    return run.duration, run.rtol, run.max_events, run.shortest_event


def test_a_name_a_path_and_a_scenario_give_the_scenarios_run(file: Path) -> None:
    for source in (file, str(file), ss.load_scenario(file)):
        run = ss.simulate(source)
        assert run.problem == ss.scenarios["fig6-slab"].problem
        assert options_of(run) == (3.0, 1e-8, 4, 1e-3)
    assert options_of(ss.simulate("fig6-slab")) == (12.0, 1e-10, None, None)


def test_what_is_given_replaces_what_the_scenario_says(file: Path) -> None:
    run = ss.simulate(file, 2.0, 1e-9, max_events=3, shortest_event=2e-3)
    assert options_of(run) == (2.0, 1e-9, 3, 2e-3)
    assert options_of(ss.simulate(file, max_events=1)) == (3.0, 1e-8, 1, 1e-3)


def test_a_catalogue_takes_names_too() -> None:
    table = ss.catalogue("cycles-block", max_events=2)
    problem = ss.scenarios["cycles-block"].problem
    assert table.equals(ss.catalogue(problem, ss.scenarios["cycles-block"].duration, max_events=2))
    assert len(table) == 2


def test_uniqueness_takes_names_files_and_scenarios(file: Path) -> None:
    """alpha_c = Z / (S (muS - muD)) of the slab of Fig. 6 is 9.8e6 / 0.5e8."""
    for source in ("fig6-slab", file, ss.scenarios["fig6-slab"], ss.scenarios["fig6-slab"].problem):
        found = ss.uniqueness(source)
        assert found.regime == "irregular"
        assert found.critical_value == pytest.approx(0.196, rel=1e-14, abs=0)


def test_the_list_of_scenarios_has_all_names_each_with_a_line() -> None:
    assert list(ss.scenarios) == names() == list(entries())
    assert len(ss.scenarios) == len(names())
    for name, line in zip(names(), repr(ss.scenarios).splitlines(), strict=True):
        assert line.split(maxsplit=1) == [name, ss.scenarios[name].title]
        assert len(line) <= 100
        assert f"<th style='text-align:left'>{name}</th>" in ss.scenarios._repr_html_()
    assert "fig6-slab" in ss.scenarios
    assert "fig6" not in ss.scenarios
    assert ss.scenarios["fig6-slab"] == ss.load_scenario("fig6-slab")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("fig6-slap", "no bundled scenario 'fig6-slap'; did you mean 'fig6-slab'?"),
        ("mine.toml", "no bundled scenario 'mine.toml'; a file is read with ss.load_scenario"),
        (3, "scenarios: a name must be text, such as 'fig6-slab', got 3"),
    ],
)
def test_a_name_that_is_not_bundled_is_refused_in_one_line(name: str, message: str) -> None:
    with pytest.raises(ss.InputError) as caught:
        ss.scenarios[name]
    assert str(caught.value) == message


def test_the_list_is_not_hidden_by_the_package_of_its_name() -> None:
    """Importing modules of `stickslip.problem.scenarios` would set the attribute of that name to the package."""
    code = (
        "import stickslip.problem.scenarios.scenario, stickslip as ss; print(len(ss.scenarios), ss.scenarios['fig6-slab'].duration)"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said == f"{len(names())} 12.0\n"
