"""The engine as plain Python, with every memory access checked, does what compiled code does."""

from __future__ import annotations

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from tests.core.engine.uncompiled_runs import RUNS, results


@pytest.fixture(scope="module")
def uncompiled(request: pytest.FixtureRequest) -> dict[str, dict[str, object]]:
    """Results of the runs that tests of this session ask for, in a process that compiles nothing."""
    cases = (getattr(item, "callspec", None) for item in request.session.items if request.path == item.path)
    names = [case.params["name"] for case in cases if case is not None and "name" in case.params]
    command = [sys.executable, "-m", "tests.core.engine.uncompiled_runs", *names]
    environment = os.environ | {"STICKSLIP_UNCOMPILED": "1"}
    answer = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    assert answer.returncode == 0, answer.stderr[-2000:]
    found: dict[str, dict[str, object]] = json.loads(answer.stdout)
    return found


@pytest.mark.sampled(every=15)
@pytest.mark.parametrize("name", RUNS)
def test_plain_python_gives_what_compiled_code_gives(uncompiled: dict[str, dict[str, object]], name: str) -> None:
    """To 1e-9: compiled code may fuse a product and a sum, which rounds once instead of twice."""
    plain, compiled = uncompiled[name], results(name)
    assert plain["status"] == compiled["status"]
    for quantity in ("slip", "load", "events"):
        expected = np.array(compiled[quantity], float)
        size = np.abs(expected).max(initial=0.0)
        assert np.array(plain[quantity], float) == pytest.approx(expected, rel=1e-9, abs=1e-9 * size), quantity


def test_a_place_outside_an_array_is_an_error() -> None:
    from stickslip.foundation.kernels.uncompiled import Pointer, lend_memory, pointer_at

    numbers = np.arange(6.0)
    lend_memory(numbers)
    pointer = pointer_at(numbers.ctypes.data + 16, float)
    assert (pointer[0], pointer.ahead(3)[0], pointer.address) == (2.0, 5.0, numbers.ctypes.data + 16)
    pointer[1] = 7.0
    assert numbers[3] == 7.0
    for wrong in (-3, 4):
        with pytest.raises(IndexError, match="of an array of 6 numbers"):
            pointer[wrong]
    with pytest.raises(IndexError, match="no address"):
        pointer_at(numbers.ctypes.data + 48, float)
    assert isinstance(Pointer(numbers).ahead(1), Pointer)
