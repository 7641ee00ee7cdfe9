"""What JAX has compiled for a run is found by later processes in a private folder of bounded size, and nothing else changes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import threading
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import jax
import numpy as np
import pytest
from jax.experimental.compilation_cache.compilation_cache import reset_cache

import stickslip as ss
from stickslip.extensions.planar import compiled_before
from stickslip.extensions.planar.compiled_before import COMPILED_BEFORE, FOLDER, SETTINGS, usable_folder
from stickslip.extensions.planar.solver import functions_of
from tests.extensions.planar.patches import patch

PUT, FOUND = "/jax/compilation_cache/cache_misses", "/jax/compilation_cache/cache_hits"
"""What JAX tells its listeners when it keeps what it has compiled, and when it finds it."""


def forget() -> None:
    """Forget what this process has compiled, as if it were another one."""
    functions_of.cache_clear()
    jax.clear_caches()
    usable_folder.cache_clear()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Our folder in a cache that is still empty, in a process whose user has no cache of JAX."""
    theirs = {name: getattr(jax.config, name) for name in (FOLDER, *SETTINGS)}
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path / "cache"))
    jax.config.update(FOLDER, None)
    reset_cache()
    forget()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield tmp_path / "cache" / "jax"
    for name, value in theirs.items():
        jax.config.update(name, value)
    reset_cache()
    forget()


@pytest.fixture
def told() -> Iterator[Counter[str]]:
    """How often JAX has told what."""
    counts = Counter[str]()

    def listen(event: str, **_: object) -> None:
        counts[event] += 1

    jax.monitoring.register_event_listener(listen)
    yield counts
    jax.monitoring.unregister_event_listener(listen)


def fault() -> bytes:
    """Run a small fault for two round trips and return its slip, to the last bit."""
    return np.asarray(ss.simulate(patch(nodes=32, length=40e3), 6.0).slip).tobytes()


def march(x: jax.Array) -> jax.Array:
    return jax.numpy.sin(x) + 1.0


def run(nodes: int = 32) -> bytes:
    """Compute something as a run does, but something that is compiled in a moment."""
    with COMPILED_BEFORE.in_use():
        return np.asarray(jax.jit(march)(np.arange(float(nodes)))).tobytes()


def names(folder: Path) -> set[str]:
    return {path.name.partition("-")[0] for path in folder.glob("*-cache")}


def settings() -> list[object]:
    return [getattr(jax.config, name) for name in (FOLDER, *SETTINGS)]


@pytest.mark.slow
def test_what_was_compiled_is_found_later_and_gives_the_same_bits(folder: Path, told: Counter[str]) -> None:
    before = settings()
    first = fault()
    assert (told[PUT] > 0, told[FOUND]) == (True, 0)
    assert {"jit_march", "jit_opened", "jit_turn"} <= names(folder)
    assert folder.stat().st_mode & 0o777 == 0o700
    assert settings() == before
    kept = told[PUT]
    forget()
    assert fault() == first
    assert (told[PUT], told[FOUND]) == (kept, kept)
    forget()
    jax.config.update("jax_enable_compilation_cache", False)
    try:
        assert fault() == first
    finally:
        jax.config.update("jax_enable_compilation_cache", True)
    assert told[FOUND] == kept


def test_other_code_of_the_user_is_not_kept_with_it(folder: Path) -> None:
    def mine(x: jax.Array) -> jax.Array:
        return jax.numpy.cos(x) + 1.0

    jax.jit(mine)(np.ones(2))
    run()
    jax.config.update("jax_persistent_cache_min_compile_time_secs", 0.0)
    jax.jit(mine)(np.ones(3))
    assert names(folder) == {"jit_march"}


@pytest.mark.parametrize("moment", ["before", "meanwhile"])
def test_a_folder_that_the_user_has_chosen_stays(folder: Path, tmp_path: Path, moment: str) -> None:
    theirs = str(tmp_path / "theirs")
    if moment == "before":
        jax.config.update(FOLDER, theirs)
        run()
        assert not folder.exists()
        assert names(Path(theirs))
    else:
        with COMPILED_BEFORE.in_use():
            jax.config.update(FOLDER, theirs)
    assert getattr(jax.config, FOLDER) == theirs


def test_runs_side_by_side_leave_the_settings_of_the_user(folder: Path) -> None:
    before, found = settings(), set[bytes]()
    threads = [threading.Thread(target=lambda: found.add(run())) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 1
    assert settings() == before
    assert "jit_march" in names(folder)


def test_the_folder_keeps_its_bound_and_loses_what_is_oldest(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run()
    first = {path.name: path.stat().st_size for path in folder.glob("*-cache")}
    monkeypatch.setitem(SETTINGS, "jax_compilation_cache_max_size", sum(first.values()) + 1000)
    run(nodes=40)
    second = {path.name: path.stat().st_size for path in folder.glob("*-cache")}
    assert 0 < sum(second.values()) <= sum(first.values()) + 1000
    assert set(second) - set(first)
    assert set(first) - set(second)


def test_a_cache_that_cannot_be_made_is_no_fault(folder: Path, told: Counter[str], capfd: pytest.CaptureFixture[str]) -> None:
    folder.parent.write_text("a file where a folder should be")
    assert run()
    assert told[PUT] == told[FOUND] == 0
    assert capfd.readouterr().err == ""


def test_a_medium_that_cannot_be_written_is_no_fault(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def only_read(path: object, mode: int) -> bool:
        return not mode & os.W_OK

    monkeypatch.setattr(compiled_before.os, "access", only_read)  # for the superuser, who may all, no mode refuses it
    before = settings()
    with COMPILED_BEFORE.in_use():
        assert settings() == before


def test_a_full_disk_is_no_fault(
    folder: Path, told: Counter[str], monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    write = Path.write_bytes

    def half(path: Path, content: bytes) -> int:
        write(path, content[: len(content) // 2])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", half)
    first = run()
    monkeypatch.undo()
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(folder.parent))
    assert capfd.readouterr().err == ""
    assert names(folder)
    for path in folder.glob("*-cache"):
        os.utime(path, (0.0, 0.0))  # it was long ago
    for found in (0, 1):
        forget()
        assert run() == first
        assert told[FOUND] == found


def test_damaged_files_are_compiled_anew_once(folder: Path, told: Counter[str]) -> None:
    first = run()
    for path in folder.glob("*-cache"):
        content = path.read_bytes()
        path.write_bytes(content[:-9] + bytes([content[-9] ^ 1]) + content[-8:])
    kept = told[PUT]
    forget()
    assert run() == first
    assert (told[PUT], told[FOUND]) == (2 * kept, 0)
    forget()
    assert run() == first
    assert (told[PUT], told[FOUND]) == (2 * kept, kept)


def test_a_folder_that_others_could_change_is_emptied_and_a_link_is_not_used(folder: Path, tmp_path: Path) -> None:
    first = run()
    folder.chmod(0o777)
    (folder / "jit_of_others-0-cache").write_bytes(b"code of others")
    forget()
    assert run() == first
    assert "jit_of_others" not in names(folder)
    folder.rename(tmp_path / "elsewhere")
    folder.symlink_to(tmp_path / "elsewhere")
    forget()
    assert usable_folder(folder.parent) is None


def test_a_version_of_jax_that_would_write_errors_keeps_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled_before.jaxlib.version, "__version__", "0.10.1")
    assert usable_folder(folder.parent) is None


SCRIPT = """
import hashlib, json, jax, stickslip as ss
from tests.extensions.planar.patches import patch
told = []
jax.monitoring.register_event_listener(lambda event, **_: told.append(event.rpartition("/")[2]))
slip = ss.simulate(patch(nodes=32, length=40e3), 6.0).slip
counts = [told.count("cache_misses"), told.count("cache_hits")]
print(json.dumps([hashlib.sha256(slip.tobytes()).hexdigest(), *counts, jax.config.jax_compilation_cache_dir]))
"""


@pytest.mark.slow
def test_another_process_finds_it_as_a_user_has_it(tmp_path: Path) -> None:
    """In processes without the settings of the tests: the code is optimised, and JAX is as it is installed."""
    env = {name: value for name, value in os.environ.items() if not name.startswith("JAX_")} | {
        "STICKSLIP_CACHE_DIR": str(tmp_path)
    }
    root = Path(__file__).parents[3]

    def process() -> list[object]:
        done = subprocess.run([sys.executable, "-c", SCRIPT], env=env, cwd=root, check=True, capture_output=True, text=True)
        assert done.stderr == ""
        return list(json.loads(done.stdout))

    (bits, put, found, theirs), again = process(), process()
    assert (put, found, theirs) == (put, 0, None)
    assert again == [bits, 0, put, None]
