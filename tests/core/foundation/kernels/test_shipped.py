"""Machine code comes with the package: nobody compiles, and where it cannot serve, one line says why and it is made anew."""

from __future__ import annotations

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from shutil import copytree, ignore_patterns

import pytest

from stickslip.engine import build
from stickslip.engine.history.status import engine_key
from stickslip.foundation import code_key
from stickslip.foundation.code_key import SHIPPED, key_of_files
from stickslip.foundation.kernels import code
from stickslip.foundation.kernels.code import NAME, SOURCES, compiled_sources
from stickslip.foundation.kernels.kernels import Entry
from stickslip.foundation.kernels.processor import PROCESSOR
from tests.core.foundation.kernels.fresh import COMMAND, printed, python

SMALL = """
import sys
import numpy as np
from stickslip.engine.series.polynomial import crossings
c, out = np.zeros(27), np.zeros(27)
c[:3] = 0.11, -0.7, 1.0
count = crossings(c, out, np.zeros(27))
print(count, *map(float.hex, out[:count]), "numba" in sys.modules)
"""
"""Calls an entry that is compiled in a second: the roots of (x - 0.25)(x - 0.45) - 0.0025."""
NEW_LAW = """
import sys
import stickslip as ss
slab = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
one = ss.Problem(slab, "0.6 + 0.17/(1 + v) + 0.0123*exp(-u/3)", 0.0, initial_excess=1e6)
print(ss.simulate(one, 3.0).status.name, "numba" in sys.modules)
"""
HASHES = """
import hashlib
import stickslip as ss
law = ss.friction.FromExpression("0.6 - 0.2*v/(v + 1.0) + 0.05*sin(7*u)")
slab = ss.Problem(ss.ElasticSlab(2800, 3500, 1e4, 1e8), law, 0.0, initial_excess=1e6)
for run in (ss.simulate("fig6-slab"), ss.simulate(slab, 8.0)):
    print(hashlib.sha256(run.history.store.pieces.tobytes() + run.history.store.residual.tobytes()).hexdigest())
"""
"""Runs of a law whose formulas came with the package, and of one whose formulas did not."""
SMALL_FILE = "polynomial.crossings.o"
MISSING = "a file of the machine code that came with the package is missing or damaged"


@pytest.fixture
def shipped(tmp_path: Path) -> Path:
    """A copy of the folder of machine code, which a test may spoil."""
    return Path(copytree(SHIPPED, tmp_path / "shipped"))


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> str:
    """What SMALL prints by machine code that came with the package, but for its last word."""
    found = printed(python(SMALL, tmp_path_factory.mktemp("cache")))
    assert found.endswith(" False\n")
    return found.removesuffix(" False\n")


def test_the_machine_code_of_every_entry_comes_with_the_package() -> None:
    """If this fails, `python -m stickslip.engine.build` has not been run since the engine was edited."""
    files = {path.name for path in (SHIPPED / NAME).iterdir()}
    build.entries()
    names = {code.kept_of(one).file: name for name, one in Entry.known.items() if one.__module__.startswith("stickslip.")}
    assert set(names) <= files
    entries = {name.removesuffix(".o").partition("-")[0] for name in files}  # an edited entry of an extension leaves its file
    assert entries == {*names.values(), "formula"}


def test_no_two_entries_have_one_name() -> None:
    """One would be called by the machine code of the other."""
    build.entries()
    there = {id(one): one for module in list(sys.modules.values()) for one in vars(module).values() if isinstance(one, Entry)}
    names = [one.name for one in there.values() if one.__module__.startswith("stickslip.")]
    assert len(names) == len(set(names)) > 30


def test_the_keys_that_came_are_found_by_the_files_and_by_no_version_of_python(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another Python makes other bytecode of the same files, and would make another key."""

    def another(texts: object, beside: str) -> str:
        raise AssertionError("the key is made, and did not come")

    monkeypatch.setattr(code_key, "key_of", another)
    assert key_of_files(compiled_sources()) == SOURCES
    engine_key.cache_clear()
    assert engine_key() in code_key.keys_that_came().values()


@pytest.mark.sampled(every=3)  # tests/test_loaded.py sees that no command loads the compiler
@pytest.mark.parametrize(
    "arguments",
    [
        ["run", "rate-and-state-block"],
        ["run", "fig6-slab", "--figure", "a.png"],
        ["check", "fig6-slab"],
    ],
    ids=" ".join,
)
def test_nothing_is_compiled_and_no_compiler_loaded(arguments: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = python(COMMAND.format(arguments=arguments), tmp_path / "cache")
    assert (printed(done).splitlines()[-1], done.stderr) == ("False 0", "")
    assert [path.name for path in (tmp_path / "cache").rglob("*.o")] == []


@pytest.mark.slow
def test_a_law_that_did_not_come_is_compiled_without_the_compiler_and_kept(tmp_path: Path) -> None:
    done = python(NEW_LAW, tmp_path)
    assert (printed(done), done.stderr) == ("finished False\n", "")
    assert {path.name.partition("-")[0] for path in tmp_path.rglob("*.o")} == {"formula"}


@pytest.mark.slow
def test_without_home_or_cache_a_run_is_as_ever_and_a_new_law_costs_one_line(tmp_path: Path) -> None:
    """Not even root can make folders in /proc."""
    nowhere = {"HOME": "/proc/home", "XDG_CACHE_HOME": "/proc/home/.cache"}
    done = python(HASHES.split("slab =")[0] + 'print(ss.simulate("fig6-slab").status.name)', "/proc/cache", **nowhere)
    assert (printed(done), done.stderr) == ("finished\n", "")
    done = python(NEW_LAW, "", **nowhere)  # without STICKSLIP_CACHE_DIR
    assert printed(done) == "finished False\n"
    (line,) = done.stderr.splitlines()
    assert line.startswith("stickslip: no cache for machine code: /proc/home")
    assert line.endswith("STICKSLIP_CACHE_DIR names another folder")


# ---- what came cannot serve ---------------------------------------------------------------------------------------------------


def damage(path: Path) -> None:
    content = path.read_bytes()
    middle = len(content) // 2
    path.write_bytes(content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :])


@pytest.mark.slow
def test_a_damaged_file_is_told_in_one_line_and_made_anew_with_the_same_bits(shipped: Path, tmp_path: Path, expected: str) -> None:
    damage(shipped / NAME / SMALL_FILE)
    told = f"stickslip: {shipped / NAME / SMALL_FILE} came with the package and is damaged: what it holds is made anew; pip install"
    for made in (True, False):  # the second process finds it in the cache
        done = python(SMALL, tmp_path / "cache", shipped)
        assert printed(done) == f"{expected} {made}\n"
        first, *rest = done.stderr.splitlines()
        assert first.startswith(told)
        assert [line.rpartition("once: ")[2] for line in rest] == [
            "a file of the machine code that came with the package is missing or damaged"
        ] * made
    assert [path.name for path in (tmp_path / "cache").rglob("*.o")] == [SMALL_FILE]


def test_damaged_keys_are_told_in_one_line_and_made_anew(shipped: Path, tmp_path: Path, expected: str) -> None:
    damage(shipped / "keys")
    done = python(SMALL, tmp_path / "cache", shipped)
    assert printed(done) == f"{expected} False\n"
    (line,) = done.stderr.splitlines()
    assert "keys came with the package and is damaged" in line


def spoil(shipped: Path, what: str) -> None:
    """Let machine code be missing in one of the ways that there are."""
    if what == "a file":
        (shipped / NAME / SMALL_FILE).unlink()
        return
    (there,) = [path for path in shipped.iterdir() if path.is_dir()]
    if what == "code of this version":
        there.rename(shipped / f"0123456789abcdef-{PROCESSOR.name}")
    elif what == "code for this processor":
        there.rename(shipped / f"{SOURCES}-linux-sparc-own-0123")
    else:
        copytree(shipped, shipped.with_name("empty"), ignore=ignore_patterns("*"))
        shipped.rename(shipped.with_name("full"))


WHY = {
    "a file": MISSING,
    "code of this version": "the code has changed since the package was built",
    "code for this processor": f"machine code for this processor ({PROCESSOR.name}) came only for linux-sparc-own-0123",
    "all": f"machine code for this processor ({PROCESSOR.name}) did not come with the package",
}


@pytest.mark.parametrize("what", WHY)
def test_why_what_came_does_not_serve_is_said(what: str, shipped: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil(shipped, what)
    monkeypatch.setattr(code, "SHIPPED", shipped)
    assert code.why_not_shipped() == WHY[what]


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("what", ["code of this version", "a file", "code for this processor", "all"])
def test_what_is_missing_is_made_after_one_line_that_says_why(what: str, shipped: Path, tmp_path: Path, expected: str) -> None:
    spoil(shipped, what)
    done = python(SMALL, tmp_path / "cache", shipped)
    assert printed(done) == f"{expected} True\n"
    assert done.stderr == f"stickslip: compiling the engine, a minute or more, once: {WHY[what]}\n"
    done = python(SMALL, tmp_path / "cache", shipped)
    assert (printed(done), done.stderr) == (f"{expected} False\n", "")


@pytest.mark.slow
@pytest.mark.parametrize("spoilt", ['sys.modules["numba"] = None', "import numba.extending as m\ndel m.lower_builtin"])
def test_where_nothing_came_and_nothing_compiles_one_line_says_so_with_the_cure(spoilt: str, tmp_path: Path) -> None:
    code = f"import sys\n{spoilt}\n" + COMMAND.format(arguments=["run", "fig6-slab"])
    done = python(code, tmp_path / "cache", tmp_path / "nothing")
    assert done.stdout.splitlines()[-1].endswith(" 2")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"stickslip: machine code for this processor ({PROCESSOR.name}) did not come with the package, and the ")
    assert line.endswith(": pip install 'stickslip[compiler]'")


def test_what_came_serves_without_the_compiler(tmp_path: Path, expected: str) -> None:
    done = python('import sys\nsys.modules["numba"] = None\n' + SMALL, tmp_path)
    assert (printed(done), done.stderr) == (f"{expected} True\n", "")  # its name stands there, without a module


@pytest.mark.slow
@pytest.mark.parametrize("script", [NEW_LAW, pytest.param(SMALL, marks=pytest.mark.slow)], ids=["formula", "entry"])
def test_two_processes_that_begin_at_once_on_an_empty_cache_get_the_same(script: str, tmp_path: Path) -> None:
    """A formula, whose code needs no numba, and an entry of the engine, which each of them compiles for some seconds."""
    cache, shipped = tmp_path / "cache", tmp_path / "nothing" if script == SMALL else None
    with ThreadPoolExecutor(2) as pool:
        one, other = pool.map(lambda _: python(script, cache, shipped), range(2))
    assert printed(one) == printed(other)
    assert [done.stderr.count("\n") for done in (one, other)] == [shipped is not None] * 2
    made = {path.name for path in cache.rglob("compiled-*/*")}
    assert made == {SMALL_FILE} if shipped else all(name.startswith("formula-") and name.endswith(".o") for name in made)
    again = python(script, cache, shipped)
    assert (printed(again).split()[:-1], again.stderr) == (printed(one).split()[:-1], "")
    assert made == {path.name for path in cache.rglob("compiled-*/*")} != set()


# ---- other processors: the same bits -------------------------------------------------------------------------------------------


def test_another_processor_than_that_at_hand_is_refused(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "stickslip", "run", "fig6-slab"],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"STICKSLIP_PROCESSOR": "haswell"},
    )
    assert (done.returncode, done.stderr) == (2, "stickslip: STICKSLIP_PROCESSOR must be empty or native, got 'haswell'\n")


@pytest.mark.slow
def test_code_for_this_processor_alone_gives_the_same_bits(tmp_path: Path) -> None:
    ours = printed(python(HASHES, tmp_path / "ours"))
    theirs = python(HASHES, tmp_path / "theirs", STICKSLIP_PROCESSOR="native")
    assert printed(theirs) == ours
    assert ours.count("\n") == 2
    assert "did not come with the package" in theirs.stderr or "came only for" in theirs.stderr
    (folder,) = (tmp_path / "theirs").glob("compiled-*")
    assert folder.name.startswith(f"compiled-{SOURCES}-")
    assert folder.name != f"compiled-{NAME}"
    assert (folder / "loop.run_until.o").exists()


@pytest.mark.slow
def test_a_run_has_the_same_bits_after_the_loop_was_damaged(shipped: Path, tmp_path: Path) -> None:
    ours = printed(python(HASHES, tmp_path / "ours"))
    damage(shipped / NAME / "loop.run_until.o")
    done = python(HASHES, tmp_path / "theirs", shipped)
    assert printed(done) == ours
    assert "loop.run_until.o came with the package and is damaged" in done.stderr
