"""Damage files at random and look at what reading them does: the same as before, one line, or something that must not be.

    python -m benchmarks.fuzz_files --checkpoints 5000 --results 2000 --catalogues 1000 --stores 1000 --seed 1
    python -m benchmarks.fuzz_files --edited 1000           # contents changed by hand, with a checksum that fits

A damaged file must be refused in one line (`refused`) or give what it gave before (`same`). A silent change, a crash, a hang or a
traceback is a failure, and the exit code is 1. Of an edited file the checksum fits, so that another result is no failure (`other`).
"""

from __future__ import annotations

import argparse
import hashlib
import multiprocessing
import shutil
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path

import h5py
import numpy as np

import stickslip as ss
from stickslip.foundation import netcdf_file
from stickslip.sweeps.results.store import open_store

LIMIT = 60.0
"""Seconds after which a worker hangs."""
BLOCK = 512
FAILURES = ("silent change", "crash", "hang", "traceback")
SWEEP = {"friction.alpha": np.linspace(0.2, 2.0, 6)}


def prepare(folder: Path) -> None:
    """Write a checkpoint, a result, two catalogues and a store."""
    problem = ss.load_scenario("cycles-block").problem
    ss.simulate(problem, 20 * ss.YEAR).save(folder / "run.nc")
    for suffix in ("csv", "nc"):
        (folder / suffix).mkdir()
        ss.catalogue(problem, 20 * ss.YEAR, folder / suffix / f"events.{suffix}")
    sweep(folder / "map.zarr")


def sweep(path: Path) -> object:
    """Run or read the sweep of the store."""
    return ss.sweep("fig6-slab", SWEEP, quantities=["slip", "pulses"], series=["slip"], samples=5, out=path, chunk=2, threads=1)


# ---- what is read, as one digest --------------------------------------------------------------------------------------------


def digest(*parts: object) -> str:
    """Return one digest of everything that was read."""
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def read_checkpoint(folder: Path) -> str:
    """Go on with the run."""
    run = ss.resume(folder / "run.nc", 30 * ss.YEAR, checkpoint=folder / "longer.nc")
    return digest(*(table.tobytes() for table in run.history.store), run.status.name)


def read_result(folder: Path) -> str:
    """Load the solution, and evaluate it."""
    run = ss.load(folder / "run.nc")
    slip = run.slip(np.linspace(0.0, run.duration, 50)).tobytes()
    return digest(*(table.tobytes() for table in run.history.store), slip, run.events.to_csv(), run.rtol, str(run.status))


def read_catalogue(folder: Path) -> str:
    """Go on with the catalogue."""
    return digest(ss.resume_catalogue(folder / "events.checkpoint.nc", 30 * ss.YEAR).to_csv())


def read_store(folder: Path) -> str:
    """Open the store to read it; where it is whole, or lacks members, call the sweep again."""
    path = folder / "map.zarr"
    found = open_store(path).load()
    sweep(path)
    found = open_store(path).load()
    values = {str(name): found[name].values.tolist() for name in found.variables}
    attributes = {str(name): found[name].attrs for name in found.variables}
    return digest(sorted(values.items()), sorted(attributes.items()), found.attrs)


READERS: dict[str, Callable[[Path], str]] = {
    "checkpoint": read_checkpoint,
    "result": read_result,
    "csv": read_catalogue,
    "nc": read_catalogue,
    "store": read_store,
    "edited": read_checkpoint,
}


# ---- damage -----------------------------------------------------------------------------------------------------------------


def copied(kind: str, whole: Path, folder: Path) -> list[Path]:
    """Copy the files of a kind; return those that are to be damaged."""
    if kind == "store":
        shutil.copytree(whole / "map.zarr", folder / "map.zarr")
        return sorted(path for path in (folder / "map.zarr").rglob("*") if path.is_file())
    if kind in ("csv", "nc"):
        for path in (whole / kind).iterdir():
            shutil.copy(path, folder / path.name)
        return sorted(folder.iterdir())
    shutil.copy(whole / "run.nc", folder / "run.nc")
    return [folder / "run.nc"]


def damage(path: Path, rng: np.random.Generator, *, may_vanish: bool) -> str:
    """Change a file at random; return how."""
    content = bytearray(path.read_bytes())
    size = max(len(content), 1)
    how = str(rng.choice(["flip", "flip", "flip", "flips", "cut", "longer", "block", "swap", *["gone"] * may_vanish]))
    begin, other = (int(rng.integers(size)) for _ in range(2))
    if how in ("flip", "flips"):
        for place in rng.integers(size, size=1 if how == "flip" else 8) if content else []:
            content[place] ^= 1 << int(rng.integers(8))
    elif how == "cut":
        del content[begin:]
    elif how == "longer":
        content += rng.bytes(BLOCK)
    elif how == "block":
        content[begin : begin + BLOCK] = rng.choice([bytes(BLOCK), rng.bytes(BLOCK)])[: len(content) - begin]
    elif how == "swap":
        width = min(BLOCK, size - max(begin, other), abs(begin - other))
        content[begin : begin + width], content[other : other + width] = (
            content[other : other + width],
            content[begin : begin + width],
        )
    path.write_bytes(content)
    if how == "gone":
        path.unlink()
    return how


def edit(path: Path, rng: np.random.Generator) -> str:
    """Change one number of one table, its shape, or an attribute, and give the file a checksum that fits."""
    path.write_bytes(path.read_bytes()[: -netcdf_file.SEAL])
    with h5py.File(path, "r+") as file:
        names = [name for name in file if name.startswith(("engine_", "history_")) and isinstance(file[name], h5py.Dataset)]
        name = str(rng.choice([name for name in names if file[name].dtype.kind in "if" and file[name].size]))
        table = file[name]
        how = str(rng.choice(["number", "number", "number", "longer", "gone", "attribute"]))
        if how == "number":
            place = tuple(int(rng.integers(length)) for length in table.shape)
            odd = (
                [-1, 0, 1, 2, 7, 10**6, 2**62, -(2**62)] if table.dtype.kind == "i" else [-1.0, 0.0, 1e300, np.inf, -np.inf, np.nan]
            )
            table[place] = odd[int(rng.integers(len(odd)))]
        elif how == "attribute":
            name = str(rng.choice(list(file.attrs)))
            file.attrs[name] = [-1, np.nan, "x", 10**12, ""][int(rng.integers(5))]
        else:
            values = table[...]
            del file[name]
            if how == "longer":
                file.create_dataset(name, data=np.concatenate([values, values]))
    netcdf_file.seal(path)
    return f"{how} of {name}"


# ---- one after the other, in a process that may die -------------------------------------------------------------------------


def outcome(kind: str, whole: Path, wanted: str, seed: int) -> tuple[str, str]:
    """Damage a copy, read it, and say what came of it."""
    rng = np.random.default_rng([seed, sorted(READERS).index(kind)])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths = copied(kind, whole, folder)
        path = paths[int(rng.integers(len(paths)))]
        before = path.read_bytes()
        how = edit(path, rng) if kind == "edited" else damage(path, rng, may_vanish=kind == "store")
        about = f"{how} in {path.relative_to(folder)}"
        if path.exists() and path.read_bytes() == before:
            return "same", about
        try:
            found = READERS[kind](folder)
        except ss.InputError as error:
            return ("refused" if "\n" not in str(error) else "traceback"), about
        except Exception:
            return "traceback", about + "\n" + traceback.format_exc()
        if found == wanted:
            return "same", about
        return ("other" if kind == "edited" else "silent change"), about


def work(pipe: Connection, whole: Path, wanted: dict[str, str]) -> None:
    """Loop of a worker: kinds and numbers in, outcomes out."""
    warnings.simplefilter("ignore")
    while (case := pipe.recv()) is not None:
        pipe.send(outcome(case[0], whole, wanted[case[0]], case[1]))


class Worker:
    """A process that is started again where it died or hung."""

    def __init__(self, whole: Path, wanted: dict[str, str]) -> None:
        self.whole, self.wanted = whole, wanted
        self.start()

    def start(self) -> None:
        """Begin a process."""
        self.pipe, theirs = multiprocessing.get_context("spawn").Pipe()
        self.process = multiprocessing.get_context("spawn").Process(
            target=work, args=(theirs, self.whole, self.wanted), daemon=True
        )
        self.process.start()
        theirs.close()

    def ask(self, kind: str, seed: int) -> tuple[str, str]:
        """Return the outcome of one case."""
        self.pipe.send((kind, seed))
        if not self.pipe.poll(LIMIT):
            found = "hang", f"seed {seed}"
        else:
            try:
                answer: tuple[str, str] = self.pipe.recv()
                return answer
            except EOFError:
                found = "crash", f"seed {seed}"
        self.process.kill()
        self.process.join()
        self.start()
        return found


def say(line: str) -> None:
    """Print a line at once."""
    sys.stdout.write(line + "\n")
    sys.stdout.flush()


def main() -> int:
    """Run the cases, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("checkpoints", "results", "catalogues", "stores", "edited"):
        parser.add_argument(f"--{name}", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    half = options.catalogues // 2
    counts = {"checkpoint": options.checkpoints, "result": options.results, "csv": half, "nc": options.catalogues - half}
    counts |= {"store": options.stores, "edited": options.edited}
    with tempfile.TemporaryDirectory() as name:
        whole = Path(name)
        prepare(whole)
        worker = Worker(whole, {kind: undamaged(kind, whole) for kind, count in counts.items() if count})
        failures = sum(fails(worker, kind, count, options.seed) for kind, count in counts.items() if count)
        worker.pipe.send(None)
        return int(failures > 0)


def undamaged(kind: str, whole: Path) -> str:
    """Return the digest of what is read where nothing is damaged."""
    with tempfile.TemporaryDirectory() as place:
        copied(kind, whole, Path(place))
        return READERS[kind](Path(place))


def fails(worker: Worker, kind: str, count: int, seed: int) -> bool:
    """Run the cases of a kind, and print what came of them; return True if there was a failure."""
    found: Counter[str] = Counter()
    for n in range(count):
        what, about = worker.ask(kind, 1_000_000 * seed + n)
        found[what] += 1
        if what in FAILURES:
            say(f"{kind} {n}: {what}: {about}")
    say(f"{kind:10s} {count:6d}: " + ", ".join(f"{what} {many}" for what, many in sorted(found.items())))
    return any(what in FAILURES for what in found)


if __name__ == "__main__":
    sys.exit(main())
