"""What `schemes` says when all is well."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path

import numpy as np
import pandas
import pytest

import stickslip as ss
from stickslip.extensions.schemes.benchmarks import BENCHMARKS
from stickslip.extensions.schemes.run import SCHEMES
from tests.command_line import Command


def test_schemes_says_which_rule_physics_tends_to_and_how_fast(command, tmp_path: Path):
    shown = command("schemes", "fig4-loop", "--scheme", "lag,contact-mass", "--nx", "50,200,800", "--out", "a.csv")
    assert (shown.code, shown.err) == (0, "")
    for text in ("2.24266", "5.21284", "Rule perfect-delay: lag.", "Rule perfect-delay, from 200 cells on: contact-mass."):
        assert text in shown.out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a-shocks.csv", "a.csv"]
    table = pandas.read_csv(tmp_path / "a.csv", comment="#")
    assert table.scheme.tolist() == ["lag"] * 3 + ["contact-mass"] * 3
    assert float(table["step"].iloc[0]) == pytest.approx(20000 / 3500 / 200, rel=1e-9, abs=0.0)
    assert f"{table.slip_error.iloc[-1]:.3g}" in shown.out
    assert f"{table.slip_order.iloc[-1]:.2f}" in shown.out


def test_all_names_the_numerical_schemes_and_others_may_follow(command):
    shown = command("schemes", "fig4-loop", "--scheme", "all,lag", "--nx", "20", "--figure", "a.svg")
    assert shown.code == 0
    assert {*re.findall(r"^([a-z0-9-]+) +20 ", shown.out, re.MULTILINE)} == {*SCHEMES, "lag"}
    assert shown.out.endswith("written: a.svg\n")


def test_every_benchmark_is_written_with_a_checksum_for_each_file(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [*BENCHMARKS][3:]:  # three are enough, and those of a fault take seconds
        monkeypatch.delitem(BENCHMARKS, name)
    said = command("benchmark", "get", "all").out
    assert said.endswith("3 problems in .: sha256sum --check all.sha256\n")
    lines = Path("all.sha256").read_text().splitlines()
    assert len(lines) == 6
    for line in lines:
        digest, file = line.split("  ")
        assert hashlib.sha256(Path(file).read_bytes()).hexdigest() == digest


def test_a_series_of_layers_is_judged_by_both_commands(command: Command) -> None:
    """Right, and in two steps of which the coarse one has values of a step before."""
    run = ss.simulate("low-velocity-zone", 12.0)
    for name, steps, late in (("right", 1200, 0.0), ("coarse", 300, 1.0), ("fine", 600, 1.0)):
        time = np.linspace(0.0, 12.0, steps + 1)
        at = np.clip(time - late * time[1], 0.0, None)
        rows = np.column_stack([time, run.slip(at), run.slip_rate(at), run.traction(at)])
        np.savetxt(f"{name}.csv", rows, delimiter=",", header="time_s,slip_m,slip_rate_m_per_s,traction_Pa", comments="")
    said = command("schemes", "low-velocity-zone", "--series", "right.csv", "--duration", "12").out
    assert "Passed, with a tolerance of 0.05: right.\n" in said
    said = command("schemes", "low-velocity-zone", "--series", "coarse.csv", "--series", "fine.csv", "--duration", "12").out
    assert re.search(r"Fine has its slip.* a step late", said)
    assert "Errors fall with the step as its power 1." in said
    refused = command("schemes", "low-velocity-zone").refusal
    assert refused.startswith("schemes: LayeredSlab has no grid: they are of an ElasticSlab")


def test_a_series_of_a_drill_string_is_judged_in_its_units(command: Command) -> None:
    run, time = ss.simulate("drill-string", 5.0), np.linspace(0.0, 5.0, 501)
    rows = np.column_stack([time, run.slip(time), run.slip_rate(time), 1e-3 * run.traction(time)])
    np.savetxt("mine.csv", rows, delimiter=",", header="t (s),slip (rad),v (rad/s),torque (kN m)", comments="")
    said = command("schemes", "drill-string", "--series", "mine.csv", "--duration", "5", "--figure", "a.svg").out
    assert "Passed, with a tolerance of 0.05: mine.\n" in said
    assert "error rad" in said
