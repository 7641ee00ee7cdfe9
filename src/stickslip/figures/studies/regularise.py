"""Figure of a study of regularisations: errors against size, and runs that approach a jump of the rule's exact answer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stickslip.figures.contact import resistance
from stickslip.figures.panels import add_legend, letter_panels, set_title, zero_line
from stickslip.figures.sheet import sheet
from stickslip.figures.style import GREY, INK, LINE_COLOURS, curve_quantity, label, quantity, shown, styled, unit_shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.place import Place
from stickslip.studies.regularisations import kind_of

if TYPE_CHECKING:
    from stickslip.studies.regularise import Regularisation

SHADES = ("#C6DBEF", "#85BCDC", "#3F8FC5", "#0B559F")
"""Colours of the runs, darkest for the smallest size; no more runs than colours are drawn."""
CASE = "contact"
"""Prefix of the variables that `resistance.data` adds for the set K."""
MEAN = r"\langle|\Delta u|\rangle"
"""Symbol of the mean slip difference."""
POINTS = 1200
"""Number of times at which each curve is evaluated."""
BEFORE, AFTER = 0.8, 1.6
"""Time shown before and after a jump, as multiples of the largest delay of the runs drawn."""


def data(study: Regularisation) -> xr.Dataset:
    """Return the errors (m) for each group of rules against size (s), and a few runs together with the exact answer, in SI.

    The runs are given around the jump at which they are latest. If they tend to no rule, or no jump is made by two of them, the
    largest sizes are given from start to end.
    """
    contents: dict[str, xr.Variable] = {
        "size": quantity("size", study.sizes, "size", "L", "s"),
        "error": quantity(("rules", "size"), [study.errors(group[0]) for group in study.groups], "mean slip difference", MEAN, "m"),
        "change": quantity("size", study.changes, "mean slip difference", MEAN, "m"),
    }
    order = study.verdict.order
    attributes = {
        "title": f"Regularised by {kind_of(study.by).title}",
        "rules": [", ".join(group) for group in study.groups],
        "target": study.target,
        "target_row": next(i for i, group in enumerate(study.groups) if study.target in group),
        "tends": int(bool(study.verdict.rules)),
        "order": order.power,
        "order_points": order.points,
    }
    dataset = xr.Dataset(contents, attrs=attributes)
    jump = _jump(study) if study.verdict.rules else None
    if jump is not None:
        return _around_jump(dataset, study, jump)
    return _with_runs(dataset, study, list(range(len(study.sizes)))[: len(SHADES)], (0.0, study.until), 0.0)


def _jump(study: Regularisation) -> int | None:
    """Return the index of the jump with the largest delay, taken at the smallest size that makes it.

    Jumps that fewer than two runs make are left out; None if there are no others.
    """
    late = np.abs(study.delays)
    done = np.isfinite(late).sum(axis=0) >= 2
    if not done.any():
        return None
    last = np.array([column[np.isfinite(column)][-1] if ok else -1.0 for column, ok in zip(late.T, done, strict=True)])
    return int(np.argmax(last))


def _around_jump(dataset: xr.Dataset, study: Regularisation, jump: int) -> xr.Dataset:
    drawn = [i for i in range(len(study.sizes)) if np.isfinite(study.delays[i, jump])][: len(SHADES)]
    at, delay = float(study.shocks.time.iloc[jump]), float(np.abs(study.delays[drawn, jump]).max())
    window = max(0.0, at - BEFORE * delay), min(study.until, at + AFTER * delay)
    with_runs = _with_runs(dataset, study, drawn, window, at).assign_attrs(jump_time=at)
    fastest = max(float(with_runs[name].max()) for name in with_runs.data_vars if str(name).endswith("_rate"))
    return with_runs.merge(resistance.data({CASE: study.problem}, 1.1 * fastest), combine_attrs="override")


def _with_runs(dataset: xr.Dataset, study: Regularisation, drawn: list[int], window: tuple[float, float], at: float) -> xr.Dataset:
    """Return the dataset with the exact answer and the runs drawn; their times count from `at` (s)."""
    contents: dict[str, xr.Variable] = {}
    meaning = ("time after the jump", "t - t_J") if at else ("time", "t")
    for name, run in (("exact", study.exact[study.target]), *((f"run{i}", study.runs[i]) for i in drawn)):
        time, (rate, load, slip) = run.curves_together(("slip_rate", "load", "slip"), *window, POINTS)
        contents |= {
            f"{name}_time": quantity(f"{name}_time", time - at, *meaning, "s"),
            f"{name}_rate": curve_quantity(f"{name}_time", rate, "slip_rate"),
            f"{name}_load": curve_quantity(f"{name}_time", load, "load"),
            f"{name}_slip_time": quantity(f"{name}_slip_time", time - at, *meaning, "s"),
            f"{name}_slip": curve_quantity(f"{name}_slip_time", slip, "slip"),
        }
    return dataset.assign(contents).assign_attrs(drawn=drawn)


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw the errors on the left and the runs on the right.

    Around a jump, those on the right show slip rate against time and the path over the set K; else slip and slip rate throughout.
    """
    figure = sheet((7.2, 5.4), **place)
    axes: Any = figure.subplot_mosaic([["errors", "upper"], ["errors", "lower"]], width_ratios=(1.2, 1))
    unit = unit_shown(dataset["size"])
    _draw_errors(axes["errors"], dataset, unit)
    marks = axes["errors"].get_legend_handles_labels()[0]
    if "jump_time" in dataset.attrs:
        titles = [f"jump at {float(dataset.attrs['jump_time']):.6g} s", "the same, over the set K"]
        _draw_time(axes["upper"], dataset, "rate")
        marks += [*_run_marks(dataset, unit), *_draw_path(axes["lower"], dataset)]
    else:
        titles = ["slip of the runs", "slip rate of the runs"]
        _draw_time(axes["upper"], dataset, "slip")
        _draw_time(axes["lower"], dataset, "rate")
        marks += _run_marks(dataset, unit)
    letter_panels(axes.values(), ["errors", *titles])
    figure.align_ylabels([axes["upper"], axes["lower"]])
    add_legend(axes["errors"], marks)
    set_title(figure, dataset.attrs["title"])
    return figure


def _draw_errors(axes: Axes, dataset: xr.Dataset, unit: tuple[str, float]) -> None:
    size, errors = shown(dataset["size"], unit), dataset["error"].values
    rules = np.atleast_1d(dataset.attrs["rules"]).tolist()
    length = unit_shown(dataset["error"], dataset["change"])
    for i, rule in enumerate(rules):
        values = np.where(errors[i] > 0.0, errors[i], np.nan) / length[1]
        text = f"(a) difference from {'every rule' if len(rules) == 1 and ',' in rule else rule}"
        axes.loglog(size, values, "o-", color=LINE_COLOURS[i % 4], markersize=3.5, label=text)
    grey: Any = {"color": GREY, "markersize": 3, "linewidth": 1.0}
    axes.loglog(size, shown(dataset["change"], length), "o--", label="(a) difference from the previous size", **grey)
    if dataset.attrs["tends"] and dataset.attrs["order_points"]:
        _draw_slope(axes, size, errors[int(dataset.attrs["target_row"])] / length[1], float(dataset.attrs["order"]))
    axes.set(xlabel=label(dataset["size"], unit), ylabel=label(dataset["error"], length))


def _draw_slope(axes: Axes, size: Floats, error: Floats, order: float) -> None:
    """Draw a triangle below the errors of the smallest sizes whose slope is the fitted order."""
    right, left = size[-3], size[-1]
    low = 0.45 * error[-1]
    high = low * (right / left) ** order
    axes.loglog([left, right, right, left], [low, low, high, low], color=GREY, linewidth=0.9)
    axes.annotate(f"{order:.2f}", (right, np.sqrt(low * high)), (4, 0), textcoords="offset points", va="center", fontsize=8)
    axes.annotate("1", (np.sqrt(left * right), low), (0, -3), textcoords="offset points", va="top", ha="center", fontsize=8)


def _runs(dataset: xr.Dataset) -> list[tuple[str, str, float]]:
    """Return name, colour and line width of each curve; the exact answer comes last and is drawn on top."""
    drawn = [int(i) for i in np.atleast_1d(dataset.attrs["drawn"])]
    return [*((f"run{i}", SHADES[k - len(drawn)], 1.5) for k, i in enumerate(drawn)), ("exact", INK, 1.0)]


def _run_marks(dataset: xr.Dataset, unit: tuple[str, float]) -> list[Artist]:
    sizes = dataset["size"].values[np.atleast_1d(dataset.attrs["drawn"]).astype(int)] / unit[1]
    texts = [*(f"(b, c) size $L$ = {size:.3g} {unit[0]}" for size in sizes), f"(b, c) exact: {dataset.attrs['target']}"]
    runs = zip(_runs(dataset), texts, strict=True)
    return [Line2D([], [], color=colour, linewidth=width, label=text) for (_, colour, width), text in runs]


def _draw_time(axes: Axes, dataset: xr.Dataset, name: str) -> None:
    runs = _runs(dataset)
    times = [dataset[f"{run}_slip_time" if name == "slip" else f"{run}_time"] for run, *_ in runs]
    values = [dataset[f"{run}_{name}"] for run, *_ in runs]
    clock, unit = unit_shown(*times), unit_shown(*values)
    for (_, colour, width), time, value in zip(runs, times, values, strict=True):
        axes.plot(shown(time, clock), shown(value, unit), color=colour, linewidth=width)
    zero_line(axes)
    axes.set(xlabel=label(times[-1], clock), ylabel=label(values[-1], unit))


def _draw_path(axes: Axes, dataset: xr.Dataset) -> list[Artist]:
    """Draw the path of each run over the set K, and return the entries of the key for this set."""
    resistance.draw_set(axes, dataset, CASE, quiet=True)
    unit, rate = unit_shown(dataset[f"{CASE}_resistance"]), unit_shown(dataset["slip_rate"])
    loads = [shown(dataset[f"{name}_load"], unit) for name, *_ in _runs(dataset)]
    for (name, colour, width), load in zip(_runs(dataset), loads, strict=True):
        axes.plot(shown(dataset[f"{name}_rate"], rate), load, color=colour, linewidth=width)
    together = np.concatenate(loads)
    margin = max(0.35 * np.ptp(together), 1e-3 * abs(together).max())
    axes.set(ylim=(together.min() - margin, together.max() + margin), ylabel=label(dataset["exact_load"], unit))
    grey: Any = {"color": GREY, "linewidth": 1.0}
    falling = (dataset[f"{CASE}_slope"].values <= 0).any()
    marks: list[Artist] = [Line2D([], [], label="(c) set K: stick, stable slip", **grey)]
    return [*marks, Line2D([], [], linestyle="--", label="(c) set K: unstable slip", **grey)] if falling else marks
