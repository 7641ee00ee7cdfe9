"""What each command of a study says when all is well."""

from __future__ import annotations

import io
import re
from importlib import import_module
from pathlib import Path

import pandas
import pytest


@pytest.mark.slow
def test_answers_of_a_block_and_a_slab_may_differ_by_a_tenth(command):
    assert re.search(r"--within .*differ.*\[default: 0\.1\]", " ".join(command("analogy", "--help").out.split()))


def test_ensemble_says_what_members_share_and_how_they_part(command, tmp_path: Path):
    options = ("--members", "2", "--duration", "1e13", "--events", "6", "--out", "a.csv", "--figure", "a.svg")
    shown = command("ensemble", "fig6-slab", *options)
    assert shown.code == 0
    assert shown.err == ""
    for text in (
        "2 members, initial load disturbed by up to 1e-12 of the strength (",
        "6 slip events",
        "1.479435009e+10",
        "All 2 members have the same 6 slip events.",
        "Exponent 2.",
        "predicted 2.",
    ):
        assert text in shown.out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.csv", "a.svg"]
    table = pandas.read_csv(tmp_path / "a.csv", comment="#")
    assert table.members.tolist() == [2] * 6
    assert f"{table.start[0]:.10g}" in shown.out


def test_ensemble_shows_events_around_the_first_that_is_lost(command):
    shown = command("ensemble", "fig6-slab", "--duration", "1e13", "--events", "65", "--members", "2")
    first, last = re.search(r"^\d+ slip events, of them (\d+) to (\d+)$", shown.out, re.MULTILINE).groups()
    lost = re.search(r"^Sequences differ from event (\d+) of \d+ on", shown.out, re.MULTILINE)[1]
    assert int(first) < int(lost) <= int(last) == int(first) + 11
    assert re.search(rf"^ +{lost} .* [01] of 2 ", shown.out, re.MULTILINE)


def test_an_interrupted_ensemble_shows_and_saves_what_is_finished(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    original = import_module("stickslip.extensions.studies.kept_runs").simulate
    done = []

    def stops(*arguments, **options):
        if len(done) == 3:
            raise KeyboardInterrupt
        done.append(original(*arguments, **options))
        return done[-1]

    monkeypatch.setattr(import_module("stickslip.extensions.studies.kept_runs"), "simulate", stops)
    shown = command("ensemble", "cycles-block", "--out", "a.csv")
    assert (shown.code, shown.err) == (130, "stickslip: interrupted\n")
    assert "Interrupted: 2 of 8 members." in shown.out
    assert "All 2 members have the same 7 slip events." in shown.out
    assert [path.name for path in tmp_path.iterdir()] == ["a.csv"]


def test_compare_says_what_each_run_did(command, tmp_path: Path):
    files = ("--figure", "both.png", "--out", "both.csv")
    shown = command("compare", "fig6-block-reconstructed", "fig6-slab", *files)
    assert shown.code == 0
    for pattern in (
        r"^fig6-block-reconstructed +perfect-delay +regular +finished",
        r"^fig6-slab +perfect-delay +irregular +finished",
        r"^fig6-block-reconstructed +1 +2\.06116 +1 +3\.51122 +70\.698 TN +38\.917 TN +2\.22645 +0$",
        r"^fig6-slab +1 +23\.4402 +1 +4\.10204 +80\.4 MPa +40\.2 MPa +5\.71429 +2$",
    ):
        assert re.search(pattern, shown.out, re.MULTILINE), pattern
    assert sorted(path.name for path in tmp_path.iterdir()) == ["both.csv", "both.png"]
    table = pandas.read_csv(tmp_path / "both.csv", comment="#")
    assert list(table.name) == ["fig6-block-reconstructed", "fig6-slab"]
    assert table.slip[1] == pytest.approx(23.4402332474, rel=1e-9, abs=0.0)


def test_analogy_maps_a_scenario(command, tmp_path: Path):
    axes = ("--map", "wavelength=5..41.6:2:log", "--map", "alpha=0.00392..1:2:log")
    shown = command("analogy", "block-or-slab", *axes, "--out", "map.csv", "--figure", "map.png")
    assert shown.code == 0
    assert "The block stands for the slab at 1 of 4 points" in shown.out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.csv", "map.png"]
    assert list(pandas.read_csv(tmp_path / "map.csv", comment="#").stands) == [False, True, False, False]


def test_a_run_to_compare_comes_from_standard_input(command, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(command("new", "fig6-slab").out.encode())))
    compared = command("compare", "-", "fig6-slab").out
    assert re.search(r"^stdin +1 +23\.4402", compared, re.MULTILINE)
