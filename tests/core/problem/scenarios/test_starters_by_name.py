"""Starters are scenarios by their names, as those are that come with the package."""

from pathlib import Path

import pytest

import stickslip as ss
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.templates import template


@pytest.mark.parametrize("name", library.STARTERS)
def test_a_starter_is_read_by_its_name_as_from_the_file_that_new_writes(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("written.toml").write_text(template(name))
    by_name, written = ss.load_scenario(name), ss.load_scenario("written.toml")
    assert (by_name.name, by_name.problem, by_name.duration) == (name, written.problem, written.duration)


def test_no_starter_has_the_name_of_a_bundled_scenario() -> None:
    assert set(library.STARTERS).isdisjoint(library.names())


def test_a_file_that_has_the_name_of_a_starter_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("block").write_text(template("slab"))
    assert ss.load_scenario("block").problem == ss.load_scenario("slab").problem


def test_commands_take_starters(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    told = command("run", "block", "--duration", "1")
    assert told.code == 0, told.err
    assert told.out.startswith("block\n")
    assert command("check", "block").code == 0
    assert "runs a scenario" in command("show", "block").refusal
