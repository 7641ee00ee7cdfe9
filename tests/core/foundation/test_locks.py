"""Names are reserved against other processes also where the system has no flock, as on Windows."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

pytest.importorskip("filelock", reason="a library that the package needs: install it anew")

WITHOUT_FLOCK = """
import sys
sys.modules["fcntl"] = None  # as on Windows: its import fails
import warnings
warnings.filterwarnings("ignore", "only soft file lock is available")  # Windows has locks of its own
from pathlib import Path
from stickslip.foundation.errors import InputError
from stickslip.foundation.locks import HAS_FLOCK, held
assert not HAS_FLOCK
place = Path(sys.argv[1])
try:
    with held(place, "another run is writing into it"):
        print("held", flush=True)
        sys.stdin.readline()
except InputError as error:
    print(error, flush=True)
"""


@contextmanager
def reserving(place: Path) -> Iterator[subprocess.Popen[str]]:
    """Run a process without flock that reserves a name, and releases it after a line of input."""
    command = [sys.executable, "-c", WITHOUT_FLOCK, str(place)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        yield process
        process.kill()


def said_by(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", ["run.nc", "folder"])
def test_a_name_is_reserved_without_flock_until_its_process_ends(tmp_path: Path, name: str) -> None:
    (tmp_path / "folder").mkdir()
    place = tmp_path / name
    with reserving(place) as first:
        assert said_by(first) == "held"
        with reserving(place) as second:
            assert said_by(second) == "another run is writing into it"
        first.communicate("go on\n")
    with reserving(place) as third:
        assert said_by(third) == "held"
        third.kill()
        third.wait()
    with reserving(place) as fourth:  # the lock of a process that was killed holds nobody up
        assert said_by(fourth) == "held"
        fourth.communicate("go on\n")
    assert {one.name for one in tmp_path.iterdir()} == {"folder"}


def test_what_cannot_be_reserved_without_flock_is_one_line(tmp_path: Path) -> None:
    with reserving(tmp_path / "no" / "run.nc") as process:
        assert said_by(process).endswith("run.nc: cannot be written: No such file or directory")
