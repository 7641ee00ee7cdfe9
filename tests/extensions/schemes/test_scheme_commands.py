"""What `schemes` says when all is well."""

from __future__ import annotations

import re
from pathlib import Path

import pandas
import pytest

from stickslip.extensions.schemes.run import SCHEMES


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
