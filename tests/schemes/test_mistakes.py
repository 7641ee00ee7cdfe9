"""Numbers of a study are checked before the exact runs; a file without a column is told which columns it has."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from stickslip.foundation.errors import InputError
from stickslip.io.series import read_series
from stickslip.studies.schemes import schemes


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
