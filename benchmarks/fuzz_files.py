"""Damage files at random and look at what reading them does: the same as before, one line, or something that must not be.

    python -m benchmarks.fuzz_files --checkpoints 5000 --results 2000 --catalogues 1000 --stores 1000 --seed 1
    python -m benchmarks.fuzz_files --edited 1000 --metadata 1000     # contents changed by hand, with checksums that fit
    python -m benchmarks.fuzz_files --records 6000                    # files of LabVIEW, LAS and universal files, and CSV

A damaged file must be refused in one line (`refused`) or give what it gave before (`same`). A silent change, a crash, a hang, a
traceback or a change of somebody else's file beside it is a failure, and the exit code is 1. Of an edited file, and of edited
metadata of a store, the checksums fit, and a record has none, so that another result is no failure (`other`).
"""

from __future__ import annotations

import argparse
import hashlib
import multiprocessing
import sys
import tempfile
import traceback
import warnings
from collections import Counter
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
from tests.extensions.inference.files_of_programs import CLOCK, FORCE, RAM, labview, log_ascii, universal

import stickslip as ss
from benchmarks.damages import RECORDS, copied, damage, edit, edit_metadata
from stickslip.cli.stored import stored
from stickslip.extensions.sweeps.results.store import open_store
from stickslip.extensions.sweeps.shown import SweepResults

LIMIT = 60.0
"""Seconds after which a worker hangs."""
FAILURES = ("silent change", "crash", "hang", "traceback", "foreign change")
FOREIGN = ("mine.txt", "x.partial/mine.txt", ".stickslip-draft-mine.txt", "map.zarr/x.partial/mine.txt")
"""Files of somebody else, which nothing may change."""
MINE = "not yours"
SWEEP = {"friction.alpha": np.linspace(0.2, 2.0, 6)}


def prepare(folder: Path) -> None:
    """Write a checkpoint, a result, two catalogues and a store."""
    problem = ss.load_scenario("cycles-block").problem
    ss.simulate(problem, 20 * ss.YEAR).to_netcdf(folder / "run.nc")
    for suffix in ("csv", "nc"):
        (folder / suffix).mkdir()
        ss.catalogue(problem, 20 * ss.YEAR, folder / suffix / f"events.{suffix}")
    sweep(folder / "map.zarr")


def write_records(folder: Path) -> None:
    """Write a record in each format of text."""
    for kind, text in {"lvm": labview(special=True), "las": log_ascii(wrap=True), "uff": universal(code=5)}.items():
        (folder / f"record.{kind}").write_text(text)
    rows = "".join(f"{t:.3f},{f:.6f},{x:.6f}\n" for t, f, x in zip(CLOCK, FORCE, RAM, strict=True))
    (folder / "record.txt").write_text(f"rig 2\ntime (s),shear force (kN),LPD (mm)\n{rows}")


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
    run = ss.open_solution(folder / "run.nc")
    slip = run.slip(np.linspace(0.0, run.duration, 50)).tobytes()
    return digest(*(table.tobytes() for table in run.history.store), slip, run.events.to_csv(), run.rtol, str(run.status))


def read_catalogue(folder: Path) -> str:
    """Go on with the catalogue."""
    return digest(ss.resume(folder / "events.checkpoint.nc", 30 * ss.YEAR).to_csv())


def read_store(folder: Path) -> str:
    """Open the store to read it; where it is whole, or lacks members, call the sweep again."""
    path = folder / "map.zarr"
    found = open_store(path).load()
    sweep(path)
    found = open_store(path).load()
    values = {str(name): found[name].values.tolist() for name in found.variables}
    attributes = {str(name): found[name].attrs for name in found.variables}
    return digest(sorted(values.items()), sorted(attributes.items()), found.attrs)


def read_metadata(folder: Path) -> str:
    """Read the store as the command line does, and call the sweep again."""
    path = folder / "map.zarr"
    sweep(path)
    found = stored(path)
    assert isinstance(found.results, SweepResults)
    return digest({str(name): variable.values.tolist() for name, variable in found.results.dataset.variables.items()}, found.about)


def read_record(folder: Path) -> str:
    """Read the record."""
    (path,) = folder.glob("record.*")
    record = ss.studies.Record.read(path)
    columns = {**record.measured, "load_point": record.load_point}
    return digest(record.time.tobytes(), {name: None if one is None else one.tobytes() for name, one in columns.items()})


READERS: dict[str, Callable[[Path], str]] = {
    "checkpoint": read_checkpoint,
    "result": read_result,
    "csv": read_catalogue,
    "nc": read_catalogue,
    "store": read_store,
    "edited": read_checkpoint,
    "metadata": read_metadata,
    **dict.fromkeys(RECORDS, read_record),
}


# ---- one after the other, in a process that may die -------------------------------------------------------------------------


def outcome(kind: str, whole: Path, wanted: str, seed: int) -> tuple[str, str]:
    """Damage a copy beside files of somebody else, read it, and say what came of it."""
    rng = np.random.default_rng([seed, sorted(READERS).index(kind)])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        paths = copied(kind, whole, folder)
        foreign = [folder / mine for mine in FOREIGN if (folder / mine.split("/")[0]).exists() or not mine.startswith("map")]
        for mine in foreign:
            mine.parent.mkdir(exist_ok=True)
            mine.write_text(MINE)
        path = paths[int(rng.integers(len(paths)))]
        before = path.read_bytes()
        if kind == "metadata":
            how = edit_metadata(path, folder / "map.zarr", rng)
        else:
            how = edit(path, rng) if kind == "edited" else damage(path, rng, may_vanish=kind == "store")
        about = f"{how} in {path.relative_to(folder)}"
        if path.is_file() and path.read_bytes() == before:
            return "same", about
        found = of_reading(kind, folder, wanted)
        changed = [str(mine) for mine in foreign if not mine.is_file() or mine.read_text() != MINE]
        return ("foreign change", f"{about}: {changed}") if changed else (found[0], about + found[1])


def of_reading(kind: str, folder: Path, wanted: str) -> tuple[str, str]:
    """Read what lies in a folder, and say what came of it, with the traceback if there was one."""
    try:
        found = READERS[kind](folder)
    except ss.InputError as error:
        return ("refused", "") if str(error).isprintable() else ("traceback", f": {error}")
    except Exception:
        return "traceback", "\n" + traceback.format_exc()
    if found == wanted:
        return "same", ""
    return ("other" if kind in ("edited", "metadata", *RECORDS) else "silent change"), ""


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
    for name in ("checkpoints", "results", "catalogues", "stores", "edited", "metadata", "records"):
        parser.add_argument(f"--{name}", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    half = options.catalogues // 2
    counts = {"checkpoint": options.checkpoints, "result": options.results, "csv": half, "nc": options.catalogues - half}
    counts |= {"store": options.stores, "edited": options.edited, "metadata": options.metadata}
    counts |= dict.fromkeys(RECORDS, options.records // len(RECORDS))
    with tempfile.TemporaryDirectory() as name:
        whole = Path(name)
        write_records(whole)
        if any(count for kind, count in counts.items() if kind not in RECORDS):
            prepare(whole)
        worker = Worker(whole, {kind: undamaged(kind, whole) for kind, count in counts.items() if count})
        counted = {kind: outcomes(worker, kind, count, options.seed) for kind, count in counts.items() if count}
        worker.pipe.send(None)
    columns = ("same", "refused", "other", *FAILURES)
    say(f"| kind | files | {' | '.join(columns)} |\n|{' --- |' * (len(columns) + 2)}")
    for kind, found in counted.items():
        say(f"| {kind} | {found.total()} | {' | '.join(str(found[what]) for what in columns)} |")
    return int(any(found[what] for found in counted.values() for what in FAILURES))


def undamaged(kind: str, whole: Path) -> str:
    """Return the digest of what is read where nothing is damaged."""
    with tempfile.TemporaryDirectory() as place:
        copied(kind, whole, Path(place))
        return READERS[kind](Path(place))


def outcomes(worker: Worker, kind: str, count: int, seed: int) -> Counter[str]:
    """Run the cases of a kind, print each failure, and return how many came to what."""
    found: Counter[str] = Counter()
    for n in range(count):
        what, about = worker.ask(kind, 1_000_000 * seed + n)
        found[what] += 1
        if what in FAILURES:
            say(f"{kind} {n}: {what}: {about}")
    return found


if __name__ == "__main__":
    sys.exit(main())
