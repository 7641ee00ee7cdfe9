"""SCEC's text: read back by another reader, exact at the samples, right limits at shocks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.solution.files.sampling import sample

SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=7000, normal_stress=1e8)  # a round trip of exactly 4 s
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
RUN = ss.simulate(ss.Problem(SLAB, LAW, pull_rate=0.05 / ss.YEAR, initial_excess=0.0), 6.0)


def read(path: Path) -> tuple[dict[str, str], list[str], np.ndarray]:
    """Header (key=value), field names, numbers: as the benchmarks' tools do it."""
    lines = path.read_text(encoding="utf-8").splitlines()
    header = dict(line[2:].split("=", 1) for line in lines if line.startswith("# ") and "=" in line)
    rest = [line for line in lines if not line.startswith("#")]
    return header, rest[0].split(), np.array([[float(word) for word in line.split()] for line in rest[1:]])


def test_the_file_holds_what_was_computed(tmp_path: Path) -> None:
    header, fields, numbers = read(RUN.to_scec(tmp_path / "a.txt", 30.0, problem="slab", station="x = 0"))
    assert fields == ["t", "slip", "slip-rate", "shear-stress"]
    assert (header["problem"], header["location"], header["code"]) == ("slab", "x = 0", "stickslip")
    assert int(header["num_time_steps"]) == len(numbers) == 181
    assert float(header["time_step"].split()[0]) == pytest.approx(1 / 30, rel=1e-13, abs=0.0)
    time = np.arange(181) / 30.0
    np.testing.assert_allclose(numbers[:, 0], time, rtol=1e-13, atol=0.0)
    np.testing.assert_allclose(numbers[:, 1], RUN.slip(time), rtol=1e-12, atol=0.0)
    np.testing.assert_allclose(numbers[:, 2], RUN.slip_rate(time), rtol=1e-12, atol=0.0)
    np.testing.assert_allclose(numbers[:, 3], 1e-6 * RUN.traction(time), rtol=1e-12, atol=0.0)
    assert [one.name for one in tmp_path.iterdir()] == ["a.txt"]


def test_a_sample_on_a_shock_is_its_right_limit() -> None:
    """Jumps at 0 and at exactly 4 s; the sample before the second still slips."""
    series = sample(RUN, 2.0)
    assert series.slip_rate[0] == pytest.approx(4.10204081633, rel=1e-11, abs=0.0)
    assert series.slip_rate[7] == pytest.approx(4.10204082, rel=1e-8, abs=0.0)
    assert (series.time[8], series.slip_rate[8]) == (4.0, 0.0)
    assert float(RUN.slip_rate(4.0, side="left")) > 4.1


def test_all_components_of_the_benchmarks_can_be_written(tmp_path: Path) -> None:
    _, fields, numbers = read(RUN.to_scec(tmp_path / "a.txt", 1.0, components=True))
    assert fields == ["t", "h-slip", "h-slip-rate", "h-shear-stress", "v-slip", "v-slip-rate", "v-shear-stress", "n-stress"]
    assert (numbers[:, 4:7] == 0.0).all()
    assert (numbers[:, 7] == -100.0).all()  # MPa, tension positive


def test_slip_counts_from_the_start(tmp_path: Path) -> None:
    run = ss.simulate("fig5-slab-reconstructed")
    _, _, numbers = read(run.to_scec(tmp_path / "a.txt", 10.0))
    assert numbers[0, 1] == 0.0
    assert numbers[-1, 1] == pytest.approx(0.376105283, rel=2e-9, abs=0.0)


def test_a_window_is_written_in_local_time(tmp_path: Path) -> None:
    late = ss.simulate("second-event-maxwell")
    header, _, numbers = read(late.window(1).to_scec(tmp_path / "late.txt", 100.0, start=0.0, end=3.0))
    assert "round trips" in header["origin"]
    assert (numbers[0, 0], numbers[0, 1], len(numbers)) == (0.0, 0.0, 301)
    np.testing.assert_allclose(numbers[:, 2], late.window(1).slip_rate(np.arange(301) / 100.0), rtol=1e-12, atol=0.0)


def test_the_file_has_the_times_that_were_asked_for() -> None:
    series = sample(RUN, 10.0, start=0.55, end=1.0)
    assert (series.time[0], len(series.time)) == (0.55, 5)
    assert len(sample(RUN, 1 / 3).time) == 3
    assert len(sample(RUN, 0.1).time) == 1


def test_the_filter_keeps_what_is_slow_and_the_slip_of_what_is_fast() -> None:
    """Pulses some hundredths of a second long, sampled 5 times a second: samples miss them, the filtered ones hold their slip."""
    pytest.importorskip("scipy")
    run = ss.simulate("fig5-slab-reconstructed")
    raw, filtered = (sample(run, 5.0, start=1.0, end=8.0, antialias=wanted) for wanted in (False, True))
    slip = float(run.slip(8.0) - run.slip(1.0))
    assert filtered.slip_rate.sum() / 5.0 == pytest.approx(slip, rel=0.01, abs=0.0)
    assert raw.slip_rate.sum() / 5.0 != pytest.approx(slip, rel=0.2, abs=0.0)
    slow = ss.simulate("block-or-slab")
    raw, filtered = (sample(slow, 20.0, end=23.0, antialias=wanted) for wanted in (False, True))
    np.testing.assert_allclose(filtered.slip[20:-20], raw.slip[20:-20], rtol=0.0, atol=1e-3 * float(raw.slip.max()))


@pytest.mark.parametrize(
    ("rate", "options", "message"),
    [
        (0.0, {}, "sampling rate must be a positive number"),
        (1.0, {"start": 3.0, "end": 2.0}, "samples must lie within the run, 0 to 6 s, got 3 to 2 s"),
        (1.0, {"end": 7.0}, "samples must lie within the run"),
        (1e8, {}, "6e[+]08 samples are too many"),
        (1e6, {"antialias": True}, "6e[+]06 samples are too many: .* [(]at most 312500[)]"),
        (1.0, {"problem": "two\nlines"}, "problem must be one line of text"),
    ],
)
def test_bad_exports_are_refused(tmp_path: Path, rate: float, options: dict[str, object], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        RUN.to_scec(tmp_path / "a.txt", rate, **options)
    assert list(tmp_path.iterdir()) == []
