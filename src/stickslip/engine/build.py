"""Make the machine code that comes with the package: `python -m stickslip.engine.build`.

It takes a minute, and puts into the package a file for each entry of the engine and for each function of the formulas of bundled
scenarios, and the keys of the code. Whoever edits the engine may run it again, or leave it to the first run that needs the code.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor, as_completed
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path

import numpy as np

from stickslip.engine.history.status import engine_key
from stickslip.engine.input.prepare import law_tables
from stickslip.engine.lanes.setups import alike
from stickslip.engine.lanes.vectorised_problem import why_not
from stickslip.foundation.code_key import PACKAGE, SHIPPED, keys_that_came
from stickslip.foundation.kernels.code import NAME, announce_by, compiled_sources, kept_of
from stickslip.foundation.kernels.kernels import Entry
from stickslip.foundation.sealed_files import read_sealed, write_sealed
from stickslip.problem.scenarios import load_scenario
from stickslip.problem.scenarios.library import in_1d

LARGE = ("runs.run_group", "loop.run_until", "implicit_step.implicit_steps", "ladder.ladder", "layer_replay.replay")
"""Entries that take longest: processes begin with them."""
FORMULAS, KEYS = "formulas", "keys"
"""What is made beside entries."""


def main() -> None:
    """Make what is missing, and remove what is out of date."""
    parser = argparse.ArgumentParser(prog="python -m stickslip.engine.build", description="Make the machine code of the engine.")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1, help="how many processes work side by side")
    processes, begun = parser.parse_args().processes, time.perf_counter()
    is_there = (SHIPPED / NAME).is_dir()
    missing = [name for name in entries() if not (SHIPPED / NAME / kept_of(Entry.known[name]).file).exists()] if is_there else []
    if is_there and not missing and engine_key() in keys_that_came().values():
        say(f"the machine code in {SHIPPED} is up to date")
        return
    if not is_there:
        say(f"making the machine code of the engine ({NAME}) in {processes} processes: about a minute")
        shutil.rmtree(SHIPPED, ignore_errors=True)
    with tempfile.TemporaryDirectory() as made:
        os.environ["STICKSLIP_CACHE_DIR"] = made  # where the processes put machine code and keys
        (SHIPPED / "keys").unlink(missing_ok=True)
        names = missing if is_there else [*LARGE, FORMULAS, *sorted(set(entries()) - set(LARGE))]
        with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
            for done in as_completed([pool.submit(make, name) for name in [*names, KEYS]]):
                done.result()
        ship(Path(made), SHIPPED, "" if is_there and not missing else NAME)
    files = [path.stat().st_size for path in (SHIPPED / NAME).iterdir()]
    say(f"{len(files)} files of machine code, {sum(files) / 1e6:.1f} MB, in {time.perf_counter() - begun:.0f} s")


def say(text: str) -> None:
    """Write one line for who builds."""
    sys.stdout.write(f"stickslip: {text}\n")
    sys.stdout.flush()


def entries() -> list[str]:
    """Return the names of all entries."""
    for path in [*compiled_sources(), *PACKAGE.glob("extensions/*/compiled/*.py")]:
        module = path.relative_to(PACKAGE.parent).with_suffix("").as_posix().replace("/", ".")
        import_module(module.removesuffix(".__init__"))
    return list(Entry.known)


def make(name: str) -> None:
    """Make the machine code of an entry, or of formulas, or keys; they stay in the cache."""
    if name == KEYS:
        engine_key()
        _ = [kept_of(Entry.known[one]) for one in entries()]
        return
    announce_by(lambda text: None)
    entries()
    if name == FORMULAS:
        make_formulas()
    else:
        _ = Entry.known[name].address


def make_formulas() -> None:
    """Make the machine code of the formulas of all bundled scenarios, for single runs and for lanes."""
    for name in in_1d():
        scenario = load_scenario(name)
        law_tables(scenario.problem)
        if not why_not(scenario, ("run.duration",), ()):
            alike(scenario, {"run.duration": np.array([scenario.duration])})


def ship(made: Path, target: Path, name: str) -> None:
    """Move keys, and machine code if it has a name, from the cache where they were made into the package."""
    target.mkdir(exist_ok=True)
    keys = {path.name: (read_sealed(path) or b"").decode() for path in (made / "keys").iterdir()}
    write_sealed(target / "keys", "\n".join(f"{digest} {key}" for digest, key in sorted(keys.items())).encode())
    if name:
        folder = target / name if (target / name).is_dir() else target / "new"
        shutil.copytree(made / f"compiled-{name}", folder, dirs_exist_ok=True)
        folder.chmod(0o755)
        folder.rename(target / name)  # whoever looks meanwhile sees all or nothing


if __name__ == "__main__":
    main()
