"""Look at an installation: libraries, compiler, cache, extras; compare a short run of the engine with a closed form."""

from __future__ import annotations

import io
import platform
import tempfile
import time
from collections.abc import Iterator
from contextlib import redirect_stdout
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip import __version__
from stickslip.extension import found

if TYPE_CHECKING:
    from packaging.requirements import Requirement

DEVELOPERS = ("test", "bench")
"""Extras that people need who change the package; users do not."""
PROBE = bytes(65_536)
"""What is written into the cache on trial, so that a full disk shows."""
AGREE = 1e-9
"""Largest relative difference between the answer of the engine and its closed form."""


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
    yield from extras()
    yield from extensions_there()
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


def extensions_there() -> Iterator[Finding]:
    """Yield a row for our own extensions, one for each of another package, and one for each that is left out, with the reason."""
    extensions = found()
    yield Finding(
        "extensions",
        ", ".join(name for name, origin in extensions.origins.items() if not origin and name in extensions.there) or "none",
    )
    for name, origin in extensions.origins.items():
        if origin and name in extensions.there:
            yield Finding("extension", f"{name} of {origin}")
    for one in extensions.left_out:
        yield Finding("left out", f"{one.name}: {one.why}")


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


def engine() -> Iterator[Finding]:
    """Yield where the engine's machine code comes from, and the cache of machine code made here."""
    from stickslip.foundation.kernels.uncompiled import UNCOMPILED
    from stickslip.foundation.sealed_files import cache_root

    if UNCOMPILED:
        slow = "STICKSLIP_UNCOMPILED is set, so that runs take a hundred times longer or more: unset it"
        yield Finding("machine code", "not used", slow)
        return
    from stickslip.foundation.code_key import SHIPPED
    from stickslip.foundation.kernels.code import NAME, why_not_shipped
    from stickslip.foundation.kernels.processor import PROCESSOR

    came = len(list((SHIPPED / NAME).glob("*.o")))
    if came:
        yield Finding("machine code", f"for {PROCESSOR.name}, {came} files that came with the package")
    else:
        there = next((_version(one) for one in _requirements("compiler")), None)
        fault = "" if there else f"{why_not_shipped()}, and nothing compiles it: pip install 'stickslip[compiler]'"
        yield Finding("machine code", f"compiled here by numba {there or '(missing)'}: {why_not_shipped()}", fault)
    yield compiled_code(cache_root(), f"compiled-{NAME}")


def compiled_code(root: Path, name: str) -> Finding:
    """Return how much compiled code is kept in a folder of the cache; a folder that cannot be written is a fault."""
    from stickslip.foundation.private_folder import private_folder

    try:
        folder = private_folder(root / name)
        with tempfile.TemporaryFile(dir=folder) as trial:
            trial.write(PROBE)
    except OSError as error:
        reason = error.strerror or str(error)
        cure = "set STICKSLIP_CACHE_DIR to a folder that you own"
        return Finding("cache", f"none in {root}", f"compiled code cannot be kept in {root} ({reason}): {cure}")
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    return Finding("cache", f"{folder}, {size / 1e6:.1f} MB")


def self_test() -> Iterator[Finding]:
    """Yield how a short run compares with a closed form, and the time. A run that cannot be made, or another answer, is a fault.

    The slip rate of the slab of Figure 6 right after the onset is v = (muS - muD) S / Z - 1 / alpha.
    """
    begun, exact = time.perf_counter(), 0.5 * 100e6 / (2800.0 * 3500.0) - 1.0
    try:
        rate = _slip_rate_after_onset()
    except Exception as error:  # whatever a broken library raises is what the user has to know
        said = " ".join(f"{type(error).__name__}: {error}".split())
        yield Finding("self-test", "failed", f"the engine cannot run ({said}): pip install --force-reinstall stickslip")
        return
    shown = f"slip rate of a slab {rate:.10g} m/s, closed form {exact:.10g} m/s"
    cure = "remove the cache, and run it again; if it stays, please report it with all of these lines"
    yield Finding("self-test", shown, "" if abs(rate / exact - 1.0) <= AGREE else f"{shown}: {cure}")
    yield Finding("self-test", f"took {time.perf_counter() - begun:.1f} s")


def _slip_rate_after_onset() -> float:
    """Run a scenario with all that `stickslip run --figure` makes of it, so that a first such command need not compile anything."""
    import stickslip as ss
    from stickslip.cli.output.summary import show_solution

    run = ss.simulate("fig6-slab")
    with redirect_stdout(io.StringIO()):
        show_solution(ss.load_scenario("fig6-slab"), run)
    for curve in run.curves:
        run.curve(curve)
    return float(run.slip_rate(0.0))
