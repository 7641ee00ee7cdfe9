"""miniSEED and SAC through ObsPy, where it is there; one clear line where it is not."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.io.seismogram import band

RUN = ss.simulate("fig6-slab")
TIME = np.arange(601) / 50.0

needs_obspy = pytest.mark.filterwarnings("default::DeprecationWarning", "default::UserWarning")


@pytest.fixture
def obspy() -> object:
    return pytest.importorskip("obspy")


@needs_obspy
def test_miniseed_holds_every_digit(obspy, tmp_path: Path) -> None:
    paths = RUN.to_seismogram(tmp_path / "a.mseed", 50.0, origin="2024-05-01T12:00:00")
    assert paths == [tmp_path / "a.mseed"]
    rate, traction = obspy.read(str(paths[0]))
    assert (rate.id, traction.id) == ("XX.SLIDE..BXV", "XX.SLIDE..BXT")
    assert (str(rate.stats.starttime), rate.stats.sampling_rate) == ("2024-05-01T12:00:00.000000Z", 50.0)
    np.testing.assert_array_equal(rate.data, RUN.slip_rate(TIME))
    np.testing.assert_array_equal(traction.data, RUN.traction(TIME))


@needs_obspy
def test_sac_is_a_file_for_each_quantity(obspy, tmp_path: Path) -> None:
    paths = RUN.to_seismogram(tmp_path / "a.sac", 50.0, quantities=("slip", "slip_rate"))
    assert [path.name for path in paths] == ["a.slip.sac", "a.slip_rate.sac"]
    (rate,) = obspy.read(str(paths[1]))
    np.testing.assert_allclose(rate.data, RUN.slip_rate(TIME), rtol=6e-8, atol=0.0)  # 32 bits
    assert (rate.stats.sac.idep, rate.stats.sac.kuser0.strip(), rate.stats.channel) == (7, "m/s", "BXV")
    assert [path.name for path in RUN.to_seismogram(tmp_path / "b.sac", 1.0, quantities=("traction",))] == ["b.sac"]


@needs_obspy
def test_a_later_start_is_a_later_date(obspy, tmp_path: Path) -> None:
    (path,) = RUN.to_seismogram(tmp_path / "a.mseed", 10.0, start=2.5, quantities=("slip_rate",))
    (trace,) = obspy.read(str(path))
    assert str(trace.stats.starttime) == "1970-01-01T00:00:02.500000Z"
    with pytest.raises(ss.InputError, match="origin must be a date"):
        RUN.to_seismogram(tmp_path / "b.mseed", 10.0, origin="soon")


@needs_obspy
def test_a_station_of_the_example_keeps_its_numbers_times_and_codes(obspy, tmp_path: Path) -> None:
    run = ss.simulate("fig5-slab-reconstructed")
    (path,) = run.to_seismogram(tmp_path / "run.mseed", 100.0, x=4e3, station="S4")  # as example 18 names it
    rate, traction = obspy.read(str(path))
    times = np.arange(1201) / 100.0
    field = run.field(4e3, times)
    assert (rate.id, traction.id) == ("XX.S4..HXV", "XX.S4..HXT")
    for trace, expected in ((rate, field.velocity), (traction, field.stress)):
        np.testing.assert_array_equal(trace.times(), times)
        np.testing.assert_array_equal(trace.data, expected)


def test_without_obspy_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setitem(sys.modules, "obspy", None)
    with pytest.raises(ss.InputError, match=r"need ObsPy: pip install 'stickslip\[seismology\]'"):
        RUN.to_seismogram(tmp_path / "a.mseed", 10.0)
    assert list(tmp_path.iterdir()) == []


def test_names_that_say_no_format_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ss.InputError, match=r"the name must end in \.mseed or \.sac"):
        RUN.to_seismogram(tmp_path / "a.wav", 10.0)
    with pytest.raises(ss.InputError, match="unknown quantity 'slip_rat'; did you mean 'slip_rate'"):
        RUN.to_seismogram(tmp_path / "a.sac", 10.0, quantities=("slip_rat",))


def test_the_band_is_that_of_the_seed_manual() -> None:
    assert [band(rate) for rate in (2000, 500, 100, 40, 5, 1, 0.1, 0.01)] == list("FCHBMLVU")
