"""Write the exact series in docs/exact, which check-your-own-code.md offers for comparison; with --check, only compare.

python docs/exact_series.py

For each problem there is a series of time, slip, slip rate and traction as CSV, with a header of lines that begin with #: what it
is, the version that made it, the selection rule, units, and the whole scenario. All slip events of the problems are in events.csv,
all shocks in shocks.csv. Another processor may round differently: --check allows TOLERANCE.
"""

from __future__ import annotations

import csv
import io
import sys
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip.problem.scenarios.scenario import Scenario

FOLDER = Path(__file__).with_name("exact")
PROBLEMS = ("fig5-block-reconstructed-k", "fig5-slab-reconstructed", "fig6-block-reconstructed", "fig6-slab", "linear-slab")
"""Bundled scenarios, or files of the folder."""
RTOL = 1e-12
"""Relative tolerance of the runs."""
INTERVALS = 400
"""Number of equal intervals of time in a series."""
PULSES = {"fig5-slab-reconstructed": (0.154, 2.2567, 4.3594)}
"""Times (s) around which a series has rows 1 ms apart, because slip comes in pulses there."""
TOLERANCE = 1e-10
"""Largest difference that --check allows, relative to the largest magnitude in the column."""
EVENTS = ("onset_s", "arrest_s", "slip_m", "peak_slip_rate_m_per_s", "traction_before", "traction_after")
SHOCKS = ("time_s", "slip_rate_before_m_per_s", "slip_rate_after_m_per_s", "traction_before", "traction_after")


def scenario_of(problem: str) -> Scenario:
    """Return the scenario of a problem, with the tolerance of the series."""
    file = FOLDER / f"{problem}.toml"
    return replace(ss.load_scenario(file if file.exists() else problem), rtol=RTOL)


def series(run: ss.Solution, pulses: Iterable[float] = ()) -> NDArray[np.float64]:
    """Return time (s), slip since the start (m), slip rate (m/s) and traction (Pa; block: N) in columns.

    At each shock there are two rows of the same time, with the left limits and with the right limits.
    """
    shocks = run.shocks.time.to_numpy(float)
    close = [time + 1e-3 * np.arange(-20, 21) for time in pulses]
    right = np.unique(np.concatenate([np.linspace(0.0, run.duration, INTERVALS + 1), shocks, *close]))
    sides = [(shocks, "left"), (right, "right")]
    time = np.concatenate([times for times, _ in sides])
    slip = run.slip(time) - run.problem.initial_slip
    rate = np.concatenate([run.slip_rate(times, side) for times, side in sides])
    traction = np.concatenate([run.traction(times, side) for times, side in sides])
    order = np.argsort(time, kind="stable")  # stable: puts the left limits first
    return np.column_stack([time, slip, rate, traction])[order]


def header(problem: str, scenario: Scenario) -> Iterator[str]:
    """Yield the lines that say what a series is."""
    is_unique = ss.uniqueness(scenario.problem).regime == "regular"
    rule = "without effect, the slip rate is unique" if is_unique else "several slip rates solve the contact equation at some loads"
    force = "traction (Pa)" if scenario.problem.body.has_waves else "friction force (N), in the column of the traction"
    yield f"Exact series of {problem}"
    yield f"code: stickslip {ss.__version__}, rtol {RTOL:g}"
    yield f"selection rule: {scenario.problem.rule} ({rule})"
    yield f"columns: time (s), slip since the start (m), slip rate (m/s), {force}"
    yield "a shock has two rows of the same time: the values just before it, and those just after it"
    yield "the scenario, which `stickslip run` takes without the first 4 characters of each line:"
    yield ""
    yield from (f"  {line}" for line in scenario.to_toml().splitlines())


def as_csv(names: Iterable[str], rows: Iterable[Iterable[object]], about: Iterable[str] = ()) -> str:
    """Return a table as CSV with all digits, below lines about it."""
    out = io.StringIO()
    out.writelines(f"# {line}".rstrip() + "\n" for line in about)
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(rows)
    return out.getvalue()


def files() -> dict[str, str]:
    """Return the text of each file by its name."""
    found, events, shocks = {}, [], []
    for problem in PROBLEMS:
        scenario = scenario_of(problem)
        run = ss.simulate(scenario)
        unit = "Pa" if scenario.problem.body.has_waves else "N"
        names = ("time_s", "slip_m", "slip_rate_m_per_s", f"traction_{unit}")
        found[f"{problem}.csv"] = as_csv(names, series(run, PULSES.get(problem, ())).tolist(), header(problem, scenario))
        table = run.events[["start", "end", "slip", "peak_rate", "traction_before", "traction_after"]]
        events += [(problem, *row, unit) for row in table.to_numpy().tolist()]
        jumps = run.shocks[["time", "rate_before", "rate_after", "traction_before", "traction_after"]]
        shocks += [(problem, *row, unit) for row in jumps.to_numpy().tolist()]
    about = (f"code: stickslip {ss.__version__}, rtol {RTOL:g}", "traction in Pa, of a block in N: see the last column")
    found["events.csv"] = as_csv(("problem", *EVENTS, "unit"), events, ("Slip events of the exact series", *about))
    found["shocks.csv"] = as_csv(("problem", *SHOCKS, "unit"), shocks, ("Shocks of the exact series", *about))
    return found


def numbers(text: str) -> tuple[list[str], NDArray[np.float64], list[str]]:
    """Return the header of a file without the version, its numbers by row, and its texts."""
    about = [line for line in text.splitlines() if line.startswith("#") and not line.startswith("# code:")]
    names, *rows = csv.reader(line for line in text.splitlines() if not line.startswith("#"))
    texts = [k for k, name in enumerate(names) if name in ("problem", "unit")]
    values = [[float(value) for k, value in enumerate(row) if k not in texts] for row in rows]
    return about, np.array(values), [*names, *(row[k] for row in rows for k in texts)]


def differences(old: dict[str, str], new: dict[str, str]) -> Iterator[str]:
    """Yield one line for each file that is missing, or differs by more than the tolerance; versions may differ."""
    for name, text in new.items():
        if name not in old:
            yield f"{name} is missing"
            continue
        (about, values, texts), (now_about, now, now_texts) = numbers(old[name]), numbers(text)
        if about != now_about or texts != now_texts or values.shape != now.shape:
            yield f"{name} describes something else"
        elif not (np.abs(values - now) <= TOLERANCE * np.abs(now).max(axis=0)).all():
            yield f"{name} has other numbers"


def main() -> int:
    """Write the files, or say which of them must be written."""
    new = files()
    if "--check" in sys.argv:
        old = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.csv")}
        wrong = list(differences(old, new))
        sys.stdout.writelines(f"{line}: run `python docs/exact_series.py`\n" for line in wrong)
        return int(bool(wrong))
    for name, text in new.items():
        (FOLDER / name).write_text(text, encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
