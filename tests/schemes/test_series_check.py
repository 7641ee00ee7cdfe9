"""Mistakes in the series of other programs are told in one line: units, order, length, offset."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.io.series import read_series
from stickslip.schemes.series import Series
from stickslip.studies.schemes import judge_series, schemes


def test_a_column_that_is_missing_is_named_beside_those_that_are_there(tmp_path: Path) -> None:
    file = tmp_path / "a.csv"
    np.savetxt(file, np.eye(3), delimiter=",", header="time,slip,slip_rat", comments="")
    with pytest.raises(InputError, match=r"a\.csv: no column for the slip rate: call it slip_rate_m_per_s or .*slip, slip_rat$"):
        read_series(file)


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"cells": [0]}, "schemes: cells must lie between 12 and 100000, got 0"),
        ({"cells": [50, 100_001]}, "schemes: cells must lie between 12 and 100000, got 100001"),
        ({"search": "conitnue"}, "schemes: there is no search 'conitnue'; did you mean 'continue'?"),
        ({"courant": float("nan")}, "schemes: newmark: the Courant number must lie in (0, inf], got nan"),
    ],
)
def test_numbers_are_checked_before_the_exact_runs(
    numbers: dict[str, object], message: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        pytest.fail("an exact run began")

    monkeypatch.setitem(schemes.__globals__, "exact_runs", fail)
    with pytest.raises(InputError) as error:
        schemes("fig4-loop", None, "newmark", **numbers)  # type: ignore[arg-type]
    assert str(error.value) == message


@cache
def right() -> Series:
    run, time = ss.simulate("fig4-loop"), np.linspace(0.0, 5.7, 1141)
    return Series(time, run.slip(time), run.slip_rate(time), run.traction(time), "mine")


def cut(run: Series, kept: slice) -> Series:
    return replace(run, **{name: getattr(run, name)[kept] for name in ("time", "slip", "rate", "traction")})


MISTAKES: dict[str, tuple[Callable[[Series], Series], str]] = {
    "milliseconds": (lambda run: replace(run, time=1e3 * run.time), r"ends at 5700 s, the run at 5\.7 s: is its time in ms\?"),
    "short": (lambda run: cut(run, slice(0, 400)), r"ends at 1\.995 s, the run at 5\.7 s: write more"),
    "late": (lambda run: cut(run, slice(300, None)), r"begins at 1\.5 s: it must begin at t = 0"),
    "mm": (lambda run: replace(run, slip=1e3 * run.slip), r"largest slip is 10650\.2 m, exact 10\.6502 m: is it in mm\?"),
    "mm/s": (lambda run: replace(run, rate=1e3 * run.rate), r"largest slip rate is .* is it in mm/s\?"),
    "MPa": (lambda run: replace(run, traction=1e-6 * run.traction), r"is 79\.9763 Pa, exact 7\.99763e\+07 Pa: is it in MPa\?"),
    "offset": (lambda run: replace(run, slip=run.slip + 5.0), r"slip is 5 m at the start: slip must count from t = 0"),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_in_a_series_is_told_in_one_line(mistake: str) -> None:
    change, message = MISTAKES[mistake]
    with pytest.raises(InputError, match=f"mine: .*{message}") as error:
        judge_series(change(right()), "fig4-loop")
    assert "\n" not in str(error.value)


def test_times_that_go_back_are_told_with_their_place() -> None:
    time = right().time.copy()
    time[[500, 501]] = time[[501, 500]]
    with pytest.raises(InputError, match=r"mine: times must ascend, but 2\.5 s \(sample 502\) follows 2\.505 s"):
        replace(right(), time=time)


def test_a_series_that_is_wrong_without_a_wrong_unit_is_judged() -> None:
    wrong = replace(right(), slip=100.0 * right().slip, rate=0.01 * right().rate)
    assert judge_series(wrong, "fig4-loop").verdicts == {"mine": "none"}
