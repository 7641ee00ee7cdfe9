"""Count the pulses in the middle of faults of finite length, in 2D and 3D: half an hour of processor time, and gigabytes.

python docs/planar_pulses.py makes the rows that are missing in src/stickslip/extensions/paper/planar-pulses.csv, each with its
commit, draws docs/figures/planar-pulses.png, and prints the table of the page.
"""

from __future__ import annotations

import csv
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.extensions.paper.cases import Runs
from stickslip.extensions.paper.planar import (
    LARGE,
    STORED,
    Fault,
    draw_planes,
    middle_rate,
    peaks,
    planes_data,
    problem_of,
    pulses_of,
    table,
)

FIGURE = Path(__file__).with_name("figures") / "planar-pulses.png"
CURVES = STORED.with_name("planar-middle.csv")
"""Slip rates in the middle against time, of the runs in SHOWN."""
SHOWN = (("slip", LARGE, "line", 2.0, 8.0, False), ("slip", LARGE, "disc", 2.0, 5.0, False))
RATIOS = (0.25, 0.5, 1.0, 2.0)


def wanted() -> Iterator[tuple[str, float, Fault, float]]:
    """Yield the law, its excess, the fault, and the number of round trips, of each row."""

    def one(law: str, excess: float, *fault: Any, trips: float = 2.0) -> tuple[str, float, Fault, float]:
        return law, excess, Fault(problem_of(law, excess), *fault), trips

    for ratio in (*RATIOS, 4.0):
        yield from (one("slip", LARGE, ratio, "line", per_zone, trips=3.0) for per_zone in (8.0, 16.0))
    for ratio in RATIOS:
        yield one("slip", LARGE, ratio, "line", 8.0, True, trips=3.0)
        yield from (one("weakening", LARGE, ratio, "line", per_zone, trips=3.0) for per_zone in (8.0, 16.0))
        yield from (one("slip", excess, ratio, "line", per_zone) for excess in (0.01, 0.3) for per_zone in (8.0, 16.0))
    for ratio, per_zone in ((0.25, 8.0), (0.25, 16.0), (0.5, 8.0)):
        yield one("slip", 0.0, ratio, "line", per_zone, True)
    for ratio in RATIOS:  # a disc that is alone takes gigabytes after the echo
        yield one("slip", LARGE, ratio, "disc", 5.0)
        yield one("slip", LARGE, ratio, "disc", 7.0, trips=1.0)
    yield from (one("slip", LARGE, 4.0, "disc", per_zone, trips=1.0) for per_zone in (5.0, 7.0))
    yield one("slip", LARGE, 2.0, "disc", 4.0)
    for ratio in RATIOS:
        yield one("slip", LARGE, ratio, "disc", 7.0, True)
        yield one("slip", LARGE, ratio, "square", 7.0, True)
        yield one("weakening", LARGE, ratio, "disc", 7.0, True)
    yield one("slip", LARGE, 1.0, "disc", 7.0)
    yield one("weakening", LARGE, 1.0, "disc", 5.0)
    yield from (one("slip", 0.0, ratio, "line", 8.0, True, trips=1.0) for ratio in (1.0, 2.0))
    yield from (one("slip", 0.3, ratio, "disc", per_zone) for ratio in (1.0, 2.0) for per_zone in (5.0, 8.0))
    yield one("slip", 0.3, 4.0, "disc", 5.0)
    yield from (one("slip", LARGE, ratio, "square", 5.0) for ratio in (1.0, 2.0))
    yield from (one("slip", LARGE, ratio, "disc", per_zone) for ratio, per_zone in ((4.0, 4.0), (4.0, 5.0), (2.0, 7.0)))


def key_of(law: str, excess: float, fault: Fault, trips: float) -> dict[str, str]:
    """Return what names a row."""
    replicas = "period 1.25 L" if fault.replicas else "alone"
    return {
        "law": law,
        "excess": f"{excess:g}",
        "shape": fault.shape,
        "L/h": f"{fault.ratio:g}",
        "nodes per process zone": f"{fault.per_zone:g}",
        "replicas": replicas,
        "round trips": f"{trips:g}",
    }


def measured(fault: Fault, trips: float) -> tuple[dict[str, Any], np.ndarray]:
    """Run a fault, and return the columns of its row, and time and slip rate in the middle."""
    started, slab, trip = time.process_time(), fault.slab, fault.problem.round_trip_time
    run = ss.simulate(slab, trips * trip, frames=250 if slab.is_plane else 500)
    rate, ends = middle_rate(run), 0.5 * fault.length / fault.problem.body.wave_speed  # type: ignore[attr-defined]
    uniform = ss.simulate(fault.problem, 1.01 * trip)
    early = run.times < trip * (1.0 - 1e-9)
    before, all_of_them = pulses_of(rate[early]), pulses_of(rate)
    fell = np.flatnonzero((rate == 0.0) & (run.times > run.times[np.argmax(rate > 0.0)]))
    return {
        "nodes": "x".join(str(count) for count in slab.shape),
        "ends arrive [s]": f"{ends:.3f}",
        "pulses in 1D": uniform.events.pulses.iloc[0],
        "pulses in 1D until ends arrive": pulses_of(uniform.slip_rate(np.linspace(0.0, min(ends, trip), 2001)[1:])),
        "pulses before echo": before,
        "pulses after echo": all_of_them - before,
        "peaks [s]": " ".join(f"{one:.2f}" for one in peaks(run.times, rate)),
        "middle first rests [s]": f"{run.times[fell[0]]:.2f}" if len(fell) else "",
        "middle slips from echo on": int(rate[~early].max(initial=0.0) > 0.0),
        "slip in the middle [m]": f"{run.middle(np.ptp(run.slip, axis=0)):.5g}",
        "most pulses anywhere": pulses_of(run.slip_rate.reshape(len(run.times), -1)).max(),
        "rests at the end": int(not run.slip_rate[-1].any()),
        "processor time [s]": f"{time.process_time() - started:.0f}",
    }, np.stack([run.times, rate])


def main() -> None:
    """Make the rows that are missing, and write each as soon as it is there."""
    commit = subprocess.run(["git", "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True, check=True).stdout.strip()
    rows = list(csv.DictReader(STORED.open())) if STORED.exists() else []
    for item in wanted():
        key = key_of(*item)
        if any(all(row[name] == value for name, value in key.items()) for row in rows):
            continue
        found, curve = measured(*item[2:])
        rows.append(key | {name: str(value) for name, value in found.items()} | {"commit": commit})
        law, excess, fault, _ = item
        if (law, excess, fault.shape, fault.ratio, fault.per_zone, fault.replicas) in SHOWN:
            path = CURVES.with_stem(f"{CURVES.stem}-{fault.shape}")
            np.savetxt(path, curve.T, fmt="%.4f", delimiter=",", header="time [s],slip rate [m/s]", comments="")
        with STORED.open("w", newline="") as file:
            writer = csv.DictWriter(file, list(rows[-1]), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        print(*rows[-1].values(), sep="  ", file=sys.stderr, flush=True)
    draw_planes(planes_data(Runs())).savefig(FIGURE, dpi=150)
    for row in table():
        del row["commit"]
        print(f"| {' | '.join(row.values())} |")


if __name__ == "__main__":
    main()
