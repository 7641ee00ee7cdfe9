"""Look at an installation: libraries, processor, cache, terminal, extras; compare short runs of the engine with closed forms."""

from __future__ import annotations

import codecs
import io
import math
import os
import platform
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from stickslip import __version__

if TYPE_CHECKING:
    from packaging.requirements import Requirement

    from stickslip.solution.solution import Solution

DEVELOPERS = ("test", "bench")
"""Extras that people need who change the package; users do not."""
PROBE = bytes(65_536)
"""What is written into the cache on trial, so that a full disk shows."""
AGREE = 1e-9
"""Largest relative difference between an answer of the engine and its closed form."""


@dataclass(frozen=True)
class Finding:
    """One row of `stickslip doctor`: what was looked at, what it is, and in one line what is wrong, if anything, with its cure."""

    name: str
    value: str
    fault: str = ""


def installation() -> Iterator[Finding]:
    """Yield what is found about this installation, apart from the answers of the engine."""
    yield Finding("stickslip", f"{__version__} in {Path(__file__).parents[1]}")
    yield Finding("python", f"{platform.python_version()} on {platform.system()} {platform.machine()}")
    yield Finding("threads", f"{os.cpu_count() or 1} for sweeps and batches")
    yield terminal()
    yield from extras()
    yield from libraries()


def libraries() -> Iterator[Finding]:
    """Yield one row with the versions of all required libraries, and one with a fault for each that is missing or unsuitable."""
    found, wrong = [], []
    for one in _requirements():
        version = _version(one)
        found.append(f"{one.name} {version or 'missing'}")
        if version is None:
            wrong.append(Finding(one.name, "missing", f"{one.name} is not installed: pip install '{one.name}{one.specifier}'"))
        elif not one.specifier.contains(version, prereleases=True):
            fault = f"{one.name} {version} does not suit: pip install '{one.name}{one.specifier}'"
            wrong.append(Finding(one.name, version, fault))
    yield Finding("libraries", ", ".join(found))
    yield from wrong


def extras() -> Iterator[Finding]:
    """Yield a row for each extra that users may install: the versions of its libraries, or how to install them."""
    for extra in metadata.metadata("stickslip").get_all("Provides-Extra") or ():
        if extra in DEVELOPERS:
            continue
        wanted = _requirements(extra)
        versions = [_version(one) for one in wanted]
        there = all(version and one.specifier.contains(version) for one, version in zip(wanted, versions, strict=True))
        shown = ", ".join(f"{one.name} {version}" for one, version in zip(wanted, versions, strict=True))
        yield Finding(f"[{extra}]", shown if there else f"not installed: pip install 'stickslip[{extra}]'")


def _requirements(extra: str = "") -> list[Requirement]:
    """Return what the package requires here: always, or in addition for an extra."""
    from packaging.requirements import Requirement

    every = map(Requirement, metadata.requires("stickslip") or ())
    return [one for one in every if ("extra" in str(one.marker)) == bool(extra) and _applies(one, extra)]


def _applies(one: Requirement, extra: str) -> bool:
    return one.marker is None or one.marker.evaluate({"extra": extra})


def _version(one: Requirement) -> str | None:
    try:
        return metadata.version(one.name)
    except metadata.PackageNotFoundError:
        return None


def terminal() -> Finding:
    """Return the encoding of the terminal; any but UTF-8 is a fault, because titles and units may not be readable in it."""
    encoding = getattr(sys.stdout, "encoding", None) or "ascii"
    if codecs.lookup(encoding).name == "utf-8":
        return Finding("terminal", "UTF-8")
    return Finding("terminal", encoding, f"the terminal shows {encoding}, not UTF-8: set PYTHONUTF8=1, or LC_ALL=C.UTF-8")


def engine() -> Iterator[Finding]:
    """Yield the compiler with the processor for which it compiles, and the cache of compiled code. Imports the compiler."""
    with redirect_stderr(io.StringIO()):  # a cache that cannot be used is reported below, with the cure
        from stickslip.engine.compile import cache
    from llvmlite import __version__ as version
    from llvmlite.binding import get_host_cpu_name

    from stickslip.engine.compile.numba_privates import WHY_PLAIN
    from stickslip.engine.compile.uncompiled import UNCOMPILED

    way = f", plainly ({WHY_PLAIN}): first starts take some three times as long" if WHY_PLAIN else ""
    shown = f"llvmlite {version} for {get_host_cpu_name()}{way}"
    slow = "STICKSLIP_UNCOMPILED is set, so that runs take a hundred times longer or more: unset it"
    yield Finding("compiler", "not used" if UNCOMPILED else shown, slow if UNCOMPILED else "")
    yield compiled_code(cache.cache_root(), f"compiled-{cache.SOURCES}")


def compiled_code(root: Path, name: str) -> Finding:
    """Return how much compiled code is kept in a folder of the cache; a folder that cannot be written is a fault."""
    from stickslip.engine.compile.private_folder import private_folder

    try:
        folder = private_folder(root / name)
        with tempfile.TemporaryFile(dir=folder) as trial:
            trial.write(PROBE)
    except OSError as error:
        reason = error.strerror or str(error)
        cure = "set STICKSLIP_CACHE_DIR to a folder that you own"
        return Finding("cache", f"none in {root}", f"compiled code cannot be kept in {root} ({reason}): {cure}")
    old = sum(_size(one) for one in folder.parent.glob("compiled-*") if one != folder)
    rest = f", and {old / 1e6:.1f} MB of other versions, which may be removed" if old else ""
    return Finding("cache", f"{folder}, {_size(folder) / 1e6:.1f} MB{rest}")


def _size(folder: Path) -> int:
    """Return the size of all files in a folder, in bytes."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


class Trial(NamedTuple):
    """One answer of the engine, with the number that it must be."""

    name: str
    answer: float
    exact: float
    unit: str


def self_test() -> Iterator[Finding]:
    """Yield a row for each closed form with which a run is compared, and the time. A run that cannot be made is a fault."""
    begun = time.perf_counter()
    for trial in TRIALS:
        try:
            yield judged(trial())
        except Exception as error:  # whatever a broken library raises is what the user has to know
            said = " ".join(f"{type(error).__name__}: {error}".split())
            yield Finding("self-test", "failed", f"the engine cannot run ({said}): pip install --force-reinstall stickslip")
            return
    yield Finding("self-test", f"took {time.perf_counter() - begun:.1f} s")


def judged(trial: Trial) -> Finding:
    """Return the row of an answer; one that differs from the closed form is a fault."""
    name, answer, exact, unit = trial
    off = abs(answer / exact - 1.0)
    shown = f"{name} {answer:.10g} {unit}, closed form {exact:.10g} {unit}"
    if off <= AGREE:
        return Finding("self-test", shown)
    cure = "remove the cache, and run it again; if it stays, please report it with all of these lines"
    return Finding("self-test", shown, f"{shown}: {cure}")


def _block() -> Trial:
    """Slip of one event of the block under Coulomb friction: half a swing, u = 2 (muS - muD) S / K without pull."""
    import stickslip as ss
    from stickslip.reference.block import CoulombBlock

    body = ss.SpringBlock(2.8e12, 3.43e13, normal_force=1e14)
    exact = CoulombBlock(body, 0.8, 0.3, pull_rate=0.3)
    run = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.8, 0.3), pull_rate=0.3, initial_excess=0.0), 1.5 * exact.duration)
    return Trial("slip of a block", float(run.slip(exact.duration)), exact.total_slip, "m")


def _as_the_command_does(name: str) -> Solution:
    """Run a scenario with all that `stickslip run --figure` makes of it, so that a first such command need not compile anything."""
    import stickslip as ss
    from stickslip.cli.output.summary import show_solution

    run = ss.simulate(name)
    with redirect_stdout(io.StringIO()):
        show_solution(ss.load_scenario(name), run)
    for curve in run.curves:
        run.curve(curve)
    return run


def _slab_under_rate_law() -> Trial:
    """Slip rate of the slab of Figure 6 right after the onset: v = (muS - muD) S / Z - 1 / alpha."""
    run = _as_the_command_does("fig6-slab")
    drop, impedance, alpha = 0.5 * 100e6, 2800.0 * 3500.0, 1.0
    return Trial("slip rate of a slab", float(run.slip_rate(0.0)), drop / impedance - 1.0 / alpha, "m/s")


def _slab_under_slip_law() -> Trial:
    """Slip within one pulse of a slab under the sinusoidal slip law: 2 pi / omega in the period of the closed form."""
    import stickslip as ss
    from stickslip.reference.slab.pulse_period import PulseTrain

    body = ss.ElasticSlab(2800.0, 3500.0, 10e3, normal_stress=100e6)
    law = ss.friction.SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=5.0)
    problem = ss.Problem(body, law, pull_rate=0.0, initial_excess=60e6)
    period = PulseTrain(body.impedance, problem.load, problem.normal, 1.0, 0.5, 5.0).period
    run = ss.simulate(problem, period)
    return Trial("slip in a pulse of a slab", float(run.slip(period)), 2.0 * math.pi / 5.0, "m")


TRIALS: tuple[Callable[[], Trial], ...] = (_block, _slab_under_rate_law, _slab_under_slip_law)
"""The comparisons, in the order in which they are made."""
