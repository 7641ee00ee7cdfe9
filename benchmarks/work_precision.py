"""`python -m benchmarks.work_precision`: error against time, a panel for each problem, a line for each method."""

from __future__ import annotations

import math
from pathlib import Path

import matplotlib.pyplot as plt

from benchmarks.problems import DRIVEN, EVENT, TRANSIT, Case
from benchmarks.runner import Method, UnavailableError
from benchmarks.speed import LADDER, METHODS, SLOWER, interleaved

RESULTS = Path(__file__).parent / "results"
CASES = (TRANSIT, EVENT, DRIVEN)
FLOOR = 1e-16
"""Where an error of nothing at all is drawn."""
STYLES = {
    "stickslip": ("#b3362c", "o"),
    "C, same algorithm": ("#8a8a8a", "x"),
    "heyoka": ("#1f6f8b", "s"),
    "scipy DOP853": ("#3d7a3a", "^"),
    "JiTCDDE": ("#7a4f9a", "D"),
}


def points(case: Case, name: str, method: Method) -> tuple[list[float], list[float]]:
    """Median times (s) and measured errors along the ladder of tolerances; empty where the method cannot do the problem."""
    try:
        runners = {f"{tolerance:g}": method(case, tolerance) for tolerance in SLOWER.get(name, LADDER[:-2:2])}
    except UnavailableError:
        return [], []
    errors = [runner.error() for runner in runners.values()]
    times = [sorted(found)[len(found) // 2] for found in interleaved(runners, rounds=5, budget=0.05).values()]
    return times, [max(error, FLOOR) for error in errors]


def main() -> None:
    figure, axes = plt.subplots(1, len(CASES), figsize=(13.0, 4.6), sharey=True, layout="constrained")
    for axis, case in zip(axes, CASES, strict=True):
        for name, method in METHODS.items():
            times, errors = points(case, name, method)
            if times:
                colour, marker = STYLES[name]
                axis.loglog(times, errors, color=colour, marker=marker, markersize=4.5, linewidth=1.2, label=name)
        axis.axhline(case.conditioning, color="0.35", linewidth=0.9, linestyle=":", label="one rounding of the initial load")
        axis.set_title(case.title, fontsize=10)
        axis.set_xlabel("time of one run, s")
        axis.grid(True, which="major", color="0.9", linewidth=0.6)
        axis.spines[["top", "right"]].set_visible(False)
        axis.set_xlim(10.0 ** math.floor(math.log10(axis.get_xlim()[0]) + 0.3), None)
    axes[0].set_ylabel("largest error of the slip / total slip")
    handles = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=len(handles), frameon=False, fontsize=9)
    RESULTS.mkdir(exist_ok=True)
    figure.savefig(RESULTS / "work_precision.png", dpi=110)
    print(RESULTS / "work_precision.png")  # noqa: T201 - a script


if __name__ == "__main__":
    main()
