"""How much memory is free: the least that the machine, a control group and a limit of the process leave."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import pytest

import stickslip as ss
from stickslip.foundation import memory
from stickslip.foundation.memory import SHARE_OF_MEMORY, SMALL, chosen_memory, free_memory, granted, size_of

GB = 1_000_000_000


@pytest.mark.parametrize(
    ("text", "size"), [("8 GB", 8e9), ("500MB", 5e8), (" 1.5 GiB ", 1.5 * 2**30), ("4096", 4096.0), ("20 kB", 2e4), ("2 TB", 2e12)]
)
def test_sizes(text: str, size: float) -> None:
    assert size_of(text) == size


@pytest.mark.parametrize("text", ["much", "-1 GB", "0", "0 GB", "1 Gb", "nan", "1e9", "8 GB 2", "٣ GB", "GB"])
def test_what_is_no_size_is_refused(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STICKSLIP_MEMORY", text)
    with pytest.raises(ss.InputError, match=r"STICKSLIP_MEMORY: .* is not a size of memory; write it like 8 GB"):
        chosen_memory()


def test_a_run_that_grows_refuses_what_is_no_size(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STICKSLIP_MEMORY", "much")
    with pytest.raises(ss.InputError, match="STICKSLIP_MEMORY: 'much' is not a size"):
        ss.simulate("fig5-slab-printed", "4 minutes")


def test_what_is_set_counts_in_place_of_what_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STICKSLIP_MEMORY", "6 MB")
    assert granted(5e6, 3e6) == SHARE_OF_MEMORY * 6e6
    assert granted(5e5, 3e6) == 5e5


def test_a_small_result_is_granted_without_a_look(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "free_memory", lambda: pytest.fail("looked"))
    assert granted(SMALL, 0.0) == SMALL


def test_what_a_result_has_taken_counts_as_free(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "free_memory", lambda: 5.0 * GB)
    assert granted(4.0 * GB, 1.0 * GB) == SHARE_OF_MEMORY * 6.0 * GB
    assert granted(0.5 * GB, 1.0 * GB) == 0.5 * GB


def group(folder: Path, version: int, limit: object, used: int, cache: int) -> None:
    """Write the files of a control group."""
    names = memory.FILES["" if version == 2 else "memory"]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / names[0]).write_text(f"{limit}\n")
    (folder / names[1]).write_text(f"{used}\n")
    (folder / "memory.stat").write_text(f"anon 7\n{names[2]} {cache}\nshmem 0\n")


@pytest.mark.parametrize("version", [1, 2])
def test_the_narrowest_control_group_counts(version: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A batch job: no limit of its own, one of 3 GB for the user, 2 GB of them used, of which half a GB is cache of files."""
    root = tmp_path / "memory" if version == 1 else tmp_path
    lines = "4:cpu,cpuacct:/\n3:memory:/user/job\n0::/other\n" if version == 1 else "0::/user/job\n"
    group(root / "user" / "job", version, 2**63 - 4096 if version == 1 else "max", 2 * GB, 0)
    group(root / "user", version, 3 * GB, 2 * GB, GB // 2)
    monkeypatch.setattr(memory, "GROUPS", tmp_path)
    monkeypatch.setattr(memory, "OWN_GROUPS", tmp_path / "groups")
    (tmp_path / "groups").write_text(lines)
    for source in ("_of_system", "_of_limits"):
        monkeypatch.setattr(memory, source, lambda: iter((20.0 * GB,)))
    assert free_memory() == 1.5 * GB


def test_a_container_sees_its_own_group_at_the_top(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    group(tmp_path, 2, 2 * GB, GB, 0)
    monkeypatch.setattr(memory, "GROUPS", tmp_path)
    monkeypatch.setattr(memory, "OWN_GROUPS", tmp_path / "groups")
    for place in ("/", "/docker/0123", "/../.."):
        (tmp_path / "groups").write_text(f"0::{place}\n")
        assert GB in list(memory._of_groups())


def test_where_nothing_is_known_nothing_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    for source in ("_of_system", "_of_groups", "_of_limits"):
        monkeypatch.setattr(memory, source, lambda: iter(()))
    assert free_memory() == math.inf
    assert granted(1e15, 0.0) == 1e15


LIMITED = f"""
import resource
resource.setrlimit(resource.RLIMIT_AS, ({GB:.0f}, {GB:.0f}))
from stickslip.foundation.memory import free_memory
print(free_memory())
"""


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="only Linux says how much of a limit is used")
def test_a_limit_of_the_process_counts() -> None:
    shown = subprocess.run([sys.executable, "-c", LIMITED], capture_output=True, text=True, check=True)
    assert 0.3 * GB < float(shown.stdout) < GB
