"""The command infer: what it shows and writes, and what it refuses."""

from __future__ import annotations

from inspect import signature
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.cli.app import COMMANDS
from stickslip.cli.expand import expanded
from stickslip.extensions.inference.summary import as_options
from tests.extensions.inference.laboratory import RateAndStateBlock, correlated, load_point

TIMES, RATES = [0.0, 60.0, 100.0], [1e-6, 1e-5, 1e-6]


@pytest.fixture(scope="module")
def table() -> str:
    """A record of velocity steps as a CSV file."""
    clock = np.linspace(0.0, 200.0, 801)
    friction = RateAndStateBlock().friction(clock, TIMES, RATES) + 2e-4 * correlated(len(clock), 0.0, 1)
    columns = {"time (s)": clock, "load point (um)": 1e6 * load_point(clock, TIMES, RATES), "mu": friction}
    return pd.DataFrame(columns).to_csv(index=False)


@pytest.fixture(autouse=True)
def _record(table: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("data.csv").write_text(table)


def test_infer_reads_what_is_known_and_writes_what_was_asked_for(command, tmp_path: Path):
    known = ["--prior", "a=normal(0.008, 0.0001)", "--bound", "b=0.01..0.02", "--begin-at", "distance=12 um"]
    part = ["--from", "20 s", "--to", "180", "--starts", "1"]
    files = ["--out", "a.nc", "--scenario-out", "best.toml", "--figure", "a.png", "--report", "fitted"]
    shown = command(
        "infer", "velocity-steps-block", "data.csv", "--free", "a,b,distance,stiffness,reference", *known, *part, *files
    )
    assert shown.code == 0, shown.err
    assert "5 numbers from 641 samples, noise: friction 0.000" in shown.out
    assert "friction.distance" in shown.out
    assert "written: fitted/report.html" in shown.out
    assert "Fitted to data.csv" in (tmp_path / "fitted" / "report.html").read_text(encoding="utf-8")
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("a.nc", "best.toml", "a.png"))
    assert ss.load_scenario("best.toml").problem.friction.a == pytest.approx(0.008, rel=0.05)


@pytest.mark.slow
def test_infer_compares_scenarios_by_what_they_predict(command):
    Path("other.toml").write_text(ss.load_scenario("velocity-steps-block").to_toml().replace('"ageing"', '"slip"'))
    options = ["--free", "a,b", "--held-out", "105 s", "--starts", "1", "--compare", "other.toml"]
    shown = command("infer", "velocity-steps-block", "data.csv", *options)
    assert shown.code == 0, shown.err
    assert shown.out.index("rate-and-state, ageing") < shown.out.index("rate-and-state, slip")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--free", "a", "--compare", "fig6-slab"], "infer: --compare needs --held-out"),
        (["--free", "a", "--weight", "-1"], "infer: weight must be at least 0"),
        (["--free", "a", "--bound", "a=1"], "infer: --bound must be NAME=LOW..HIGH"),
        (["--free", "a", "--prior", "a"], "infer: --prior must be NAME=VALUE"),
        (["--free", "a", "--out", "a.txt"], "--out a.txt: the name must end in .nc or .csv"),
        (["--free", "a", "--parts", "events"], "infer: parts must be 'rests' or left out, got 'events'"),
        (["--free", "a", "--by", "events"], "infer: by 'events' is unknown; allowed: features, samples"),
        (["--free", "a", "--by", "features"], "data.csv: "),
        (["--free", "a", "--from", "1 kg"], "infer: begin must be"),
        ([], "infer: --free is missing"),
        (["--free", "reference", "--report", "data.csv"], "--report data.csv: data.csv is not a folder"),
    ],
)
def test_what_cannot_be_used_is_one_line(command, options, message):
    assert command("infer", "velocity-steps-block", "data.csv", *options).refusal.startswith(message)


@pytest.mark.slow
def test_windows_and_weights_are_asked_for_by_options(command):
    shown = command(
        "infer", "velocity-steps-block", "data.csv", "--free", "reference", "--starts", "1", "--windows", "--weight", "0.2"
    )
    assert shown.code == 0, shown.err
    assert "Over 8 windows of" in shown.out


def test_the_help_of_by_names_what_infer_can_fit_and_not_what_another_command_can(command):
    shown = command("infer", "--help")
    assert "features of slip events" in " ".join(shown.out.split())
    assert "contact-mass" not in shown.out


def test_a_table_in_place_of_the_scenario_gets_the_order_of_arguments(command):
    said = command("infer", "data.csv", "mine.toml", "--free", "a").refusal
    assert said == "infer: the scenario comes first, and then the data: `stickslip infer mine.toml data.csv --free a`\n"


def test_a_record_that_determines_nothing_ends_with_code_1(command):
    shown = command("infer", "velocity-steps-block", "data.csv", "--free", "body.mass", "--starts", "1")
    assert shown.code == 1
    assert "1 number from 801 samples" in shown.out
    assert "body.mass has no influence on what is fitted: fix it." in shown.out  # the name can be pasted back
    assert "The record determines none of these numbers." in shown.out


def test_arguments_of_python_are_spelt_as_options():
    assert (
        as_options("give held_out=0.3, or parts='rests' and profiles=True")
        == "give --held-out 0.3, or --parts rests and --profiles"
    )
    assert as_options("alpha=3, record.trend = 5") == "alpha=3, record.trend = 5"


def test_each_option_of_python_is_one_of_the_command_line_with_the_same_default():
    typed = signature(expanded(COMMANDS["infer"])).parameters
    for name, parameter in signature(ss.studies.infer).parameters.items():
        if parameter.kind is parameter.KEYWORD_ONLY and name != "progress":
            assert typed[name].default == parameter.default, name
