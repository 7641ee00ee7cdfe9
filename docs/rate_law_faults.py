"""Run faults under the paper's rate law that a state regularises, in 2D and 3D: half an hour of processor time.

python docs/rate_law_faults.py makes the rows that are missing in src/stickslip/extensions/paper/rate-law-faults.csv, draws
docs/figures/rate-law-faults.png, and prints the tables of the page.
"""

from __future__ import annotations

import csv
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.extensions.paper.cases import Runs
from stickslip.extensions.paper.planar import peaks
from stickslip.extensions.paper.rate_law_faults import (
    CURVES,
    SHOWN_LOADS,
    STATIONS,
    STORED,
    LaggedFault,
    at,
    fall_at_front,
    mode_of,
    rate_of_rest,
    slips_between,
)
from stickslip.extensions.paper.rate_law_report import alone_table, draw_rate_law, fronts_table, loads_table, rate_law_data

FIGURE = Path(__file__).with_name("figures") / "rate-law-faults.png"
LOADS = (50.0, 55.0, 60.0, 64.0, 66.0, 68.0, 70.0, 72.0, 75.0)
"""Background loads, MPa."""
FRONT = 12e3
"""Where the fall of friction at the front is measured, m."""


def wanted() -> Iterator[tuple[str, LaggedFault, float]]:
    """Yield the group, the fault, and the duration (s), of each row."""
    line = LaggedFault(60e6)  # 1024 nodes in 120 km
    for load in LOADS:
        yield "load", replace(line, background=load * 1e6), 16.0
    for load in (60.0, 70.0, 75.0):
        yield from (("load", replace(line, background=load * 1e6, nodes=nodes), 16.0) for nodes in (512, 2048))
        yield "load", replace(line, background=load * 1e6, reflects=True), 16.0
    for lag, nodes in ((0.4, 512), (0.4, 1024), (0.1, 2048)):
        yield "load", replace(line, background=70e6, lag=lag, nodes=nodes), 16.0
    for ratio in (1, 2, 4):
        alone = LaggedFault(81e6, nodes=128 * ratio, length=12.5e3 * ratio, nucleus=5e3 * ratio, ends=5e3 * ratio, reflects=True)
        yield from (("alone", replace(alone, nodes=nodes), 11.5) for nodes in (128 * ratio, 256 * ratio))
    for lag, nodes in ((0.8, 512), (0.4, 1024), (0.2, 2048), (0.2, 1024), (0.1, 2048)):
        yield from (("front", LaggedFault(load, lag, nodes, 48e3), 5.0) for load in (60e6, 75e6))
    for law, overload in (("distance", 81e6), ("flash-heating", 90e6)):
        others = replace(line, law=law, lag=0.4, overload=overload)
        yield from (("load", replace(others, background=load), 16.0) for load in (60e6, 75e6))
    plane = LaggedFault(60e6, 0.4, 128, 96e3, 8e3, "plane")
    for load in (60.0, 66.0, 70.0, 75.0, 78.0):
        yield from (("load", replace(plane, background=load * 1e6, nodes=nodes), 12.0) for nodes in (64, 128))
    yield "load", replace(plane, background=75e6, nodes=192), 12.0
    yield from (("load", replace(plane, background=load * 1e6, reflects=True), 12.0) for load in (60.0, 70.0, 75.0))
    disc = LaggedFault(81e6, 0.4, 64, 25e3, 10e3, "plane", reflects=True, ends=10e3)
    yield "alone", disc, 11.5
    yield "front", LaggedFault(75e6, 0.1, 4096, 48e3), 5.0


def key_of(group: str, fault: LaggedFault, duration: float) -> dict[str, str]:
    """Return what names a row."""
    return {
        "group": group,
        "law": fault.law,
        "shape": fault.shape,
        "driver": "rigid" if fault.reflects else "none",
        "background [MPa]": f"{fault.background / 1e6:g}",
        "lag [s] or distance [m]": f"{fault.lag:g}",
        "length [km]": f"{fault.length / 1e3:g}",
        "ends [km]": f"{fault.ends / 1e3:g}" if np.isfinite(fault.ends) else "",
        "nodes": f"{fault.nodes}",
        "duration [s]": f"{duration:g}",
    }


def measured(group: str, fault: LaggedFault, duration: float) -> tuple[dict[str, Any], np.ndarray]:
    """Run a fault, and return the columns of its row, and time and slip rate 16 km from the middle."""
    started, frames = time.process_time(), 2000 if group == "front" else 250 if fault.shape == "line" else 100
    run = ss.simulate(fault.slab, duration, frames=frames)
    rates = [at(run, place, run.slip_rate) for place in STATIONS]
    spans = [slips_between(run.times, rate, rate_of_rest(run)) for rate in rates]
    row: dict[str, Any] = {"mode": mode_of(run) if group != "front" else ""}
    for place, rate, (arrival, rest) in zip(STATIONS, rates, spans, strict=True):
        name = f"{place / 1e3:g} km"
        row |= {
            f"arrival, {name} [s]": f"{arrival:.3f}",
            f"rest, {name} [s]": f"{rest:.3f}",
            f"pulses, {name} [s]": " ".join(f"{one:.2f}" for one in peaks(run.times, rate)),
            f"peak, {name} [m/s]": f"{rate.max():.4g}",
        }
    row["slip in the middle [m]"] = f"{at(run, 0.0, run.slip)[-1]:.5g}"
    if group == "front":
        half, fall = fall_at_front(run.times, at(run, FRONT, run.traction))
        rate = at(run, FRONT, run.slip_rate)
        row |= {"half fallen, 12 km [s]": f"{half:.4f}", "fall, 12 km [s]": f"{fall:.5f}", "peak, 12 km [m/s]": f"{rate.max():.4g}"}
    row["processor time [s]"] = f"{time.process_time() - started:.0f}"
    return {name: value.replace("nan", "") if isinstance(value, str) else value for name, value in row.items()}, np.stack(
        [run.times, rates[2]]
    )


def main() -> None:
    """Make the rows that are missing, and write each as soon as it is there."""
    rows = list(csv.DictReader(STORED.open())) if STORED.exists() else []
    for group, fault, duration in wanted():
        key = key_of(group, fault, duration)
        if any(all(row[name] == value for name, value in key.items()) for row in rows):
            continue
        found, curve = measured(group, fault, duration)
        rows.append(key | found)
        shown = group == "load" and fault.law == "lag" and fault.shape == "line" and not fault.reflects
        if shown and fault.lag == 0.2 and fault.nodes == 1024 and fault.background / 1e6 in SHOWN_LOADS:
            path = CURVES.with_stem(f"{CURVES.stem}-{fault.background / 1e6:g}")
            np.savetxt(path, curve.T[::2], fmt="%.3f", delimiter=",", header="time [s],slip rate [m/s]", comments="")
        names = list(dict.fromkeys(name for row in rows for name in row))
        with STORED.open("w", newline="") as file:
            writer = csv.DictWriter(file, names, lineterminator="\n", restval="")
            writer.writeheader()
            writer.writerows(rows)
        print(*rows[-1].values(), sep="  ", file=sys.stderr, flush=True)
    draw_rate_law(rate_law_data(Runs())).savefig(FIGURE, dpi=150)
    for table in (loads_table(), alone_table(), fronts_table()):
        for row in table:
            print(f"| {' | '.join(row.values())} |")


if __name__ == "__main__":
    main()
