"""`stickslip magnitudes` reads a catalogue, of magnitudes or of moments, and says what Python says."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss


@pytest.fixture
def drawn() -> Any:
    return np.random.default_rng(1).exponential(1.0 / math.log(10.0), 2_000)


def test_magnitudes_in_bins_become_a_slope_a_table_and_a_figure(command, tmp_path: Path, drawn: Any) -> None:
    magnitudes = np.round(2.0 + np.floor(drawn * 10.0) / 10.0, 1)
    pd.DataFrame({"time (s)": np.arange(len(drawn)), "Mag": magnitudes}).to_csv(tmp_path / "a.csv", index=False)
    shown = command("magnitudes", "a.csv", "--bin", "0.1", "--completeness", "2", "--out", "bins.csv", "--figure", "b.png")
    assert (shown.code, shown.err) == (0, "")
    found = ss.studies.gutenberg_richter(magnitudes, 2.0, 0.1)
    assert f"= {found.b:.4g} (" in shown.out
    table = pd.read_csv(tmp_path / "bins.csv", comment="#")
    assert table.events.tolist() == found.table.events.tolist()
    assert (tmp_path / "b.png").stat().st_size > 5_000


def test_the_events_of_a_chain_are_read_as_they_were_written(command, tmp_path: Path) -> None:
    run = ss.simulate("ten-blocks")
    run.to_csv(tmp_path / "events.csv")
    shown = command("magnitudes", "events.csv", "--completeness", "-4")
    found = ss.studies.gutenberg_richter(run, -4.0)
    assert shown.code == 0
    assert f"{found.events} events" in shown.out
    assert f"= {found.b:.4g} (" in shown.out
    seismic = command("magnitudes", "events.csv", "--completeness", "-2", "--scale", "moment")
    other = ss.studies.gutenberg_richter(ss.studies.magnitudes(run, "moment"), -2.0)
    assert f"= {other.b:.4g} (" in seismic.out


REFUSED = [
    (["none.csv"], "magnitudes: there is no file none.csv"),
    (["a.csv"], "magnitudes: a.csv: no column 'magnitude' or 'mag' or"),
    (["a.csv", "--column", "x"], "magnitudes: a.csv: no column 'x'; it has size: name one by --column"),
    (["a.csv", "--column", "size", "--completeness", "9"], "gutenberg_richter: needs two events, and there are none"),
    (["b.csv"], "magnitudes: b.csv: column 'magnitude' must be a list of numbers"),
    (["bytes.csv"], "magnitudes: bytes.csv: cannot be read as CSV"),
]


@pytest.mark.parametrize(("arguments", "message"), REFUSED)
def test_what_cannot_be_read_is_refused_in_one_line(command, tmp_path: Path, arguments: list[str], message: str) -> None:
    (tmp_path / "a.csv").write_text("size\n1\n2\n3\n")
    (tmp_path / "b.csv").write_text("magnitude\n1\nlarge\n")
    (tmp_path / "bytes.csv").write_bytes(bytes(range(128, 256)))
    assert command("magnitudes", *arguments).refusal.startswith(message)
