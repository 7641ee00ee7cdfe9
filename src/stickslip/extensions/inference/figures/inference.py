"""Figure of an inference: the record and the best run, what is left, the slip rate, and pairs of the numbers that were found."""

from __future__ import annotations

import math
import string
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from stickslip.figures.names import parameter_name, symbol
from stickslip.figures.panels import add_legend, letter_panels, set_title, zero_line
from stickslip.figures.sheet import sheet
from stickslip.figures.style import (
    BLUE,
    GREY,
    INK,
    SKY,
    VERMILLION,
    curve_label,
    curve_quantity,
    quantity,
    spans_decades,
    styled,
    time_unit,
)
from stickslip.foundation.names import QUANTITIES, name_of, readable_unit, si_unit
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.inference.inference import Inference

MANY, FEW_EVENTS = 200, 50
"""Number of points from which they are drawn small, and of events up to which they are drawn large."""
MOST_PAIRED = 4
"""Largest number of parameters that are drawn against each other."""
JOINT = 2.4477468306808166
"""Half width, in standard uncertainties, of an ellipse that holds two numbers with a probability of 95 %."""
TWO = 1.96
"""Half width, in standard errors, of the band that holds a mean with a probability of 95 %."""
RECORD_PANELS = {"record": "record and best run", "residual": "residual", "rate": "slip rate of the best run"}
"""The panels of samples of a record, with their titles."""
FRAMES = 4000
"""Number of times at which the slip rate is drawn, evenly spaced, besides those of the samples."""


def inference_data(study: Inference) -> xr.Dataset:
    """Return data, model and residual of each sample, the slip rate of the runs, and the numbers with their covariance, in SI."""
    table = study.curves
    begins = np.array([part.record.time[0] for part in study.parts])  # the first sample, or the first event
    of = table.part.to_numpy()
    contents: dict[str, Any] = {
        "time": curve_quantity("sample", table.time.to_numpy() + begins[of], "time"),
        "part": xr.Variable("sample", of, {"long_name": "part of the record"}),
        "quantity": xr.Variable("sample", table.quantity.to_numpy(str), {"long_name": "what was measured"}),
        "fitted": xr.Variable("sample", table.fitted.to_numpy(np.int8), {"long_name": "1 for samples that were fitted"}),
    }
    units = {study.model.problem.unit_of(name) for name in table.quantity.unique()}
    unit = units.pop() if len(units) == 1 else "SI"
    for name, text in (("data", "measured"), ("model", "best run"), ("residual", "measured minus best run")):
        contents[name] = quantity("sample", table[name].to_numpy(), text, "", unit)
    contents |= (_rates(study) if study.features is None else _means(study.features)) | _numbers(study)
    line = study.scenario.title.partition(", part 1")[0]
    attributes = {
        "notes": "\n".join(study.notes),
        "title": line,
        "factor": study.certainty.factor,
        "load_unit": study.model.problem.load_unit,
    }
    return xr.Dataset(contents, attrs=attributes)


def _rates(study: Inference) -> dict[str, xr.Variable]:
    times, rates = list[Any](), list[Any]()
    for run, part in zip(study.runs, study.parts, strict=True):
        clock = part.record.time - part.begins
        clock = clock[clock <= part.duration]
        clock = clock if len(clock) < FRAMES else clock[:: len(clock) // FRAMES]
        at = np.union1d(np.linspace(0.0, part.duration, FRAMES // len(study.runs) + 2), clock)
        times += [at + part.begins, [math.nan]]
        rates += [run.slip_rate(at), [math.nan]]
    return {
        "run_time": curve_quantity("frame", np.concatenate(times), "time"),
        "slip_rate": curve_quantity("frame", np.concatenate(rates), "slip_rate", study.model.problem.load_unit),
    }


def _means(features: pd.DataFrame) -> dict[str, xr.Variable]:
    names = {"feature": "feature of slip events", "mean": "mean of the record", "error": "standard error of the mean", "run": "run"}
    of = xr.Variable("row", features.part.to_numpy(), {"long_name": "part of the record"})
    return {"part_of_mean": of} | {
        name: xr.Variable("row", features[name].to_numpy(str if name == "feature" else float), {"long_name": text})
        for name, text in names.items()
    }


def _numbers(study: Inference) -> dict[str, xr.Variable]:
    free, table = study.free, study.table
    covariance = study.certainty.covariance[: len(free), : len(free)]
    contents = {
        "number": xr.Variable("number", np.array([one.label for one in free])),
        "unit": xr.Variable("number", np.array([one.declared.unit for one in free])),
        "meaning": xr.Variable("number", np.array([one.declared.meaning for one in free])),
        "shared": xr.Variable("number", np.array([one.part is None for one in free], np.int8)),
        "logarithmic": xr.Variable("number", np.array([one.log for one in free], np.int8)),
        "scale": xr.Variable("number", np.array([one.scale for one in free])),
        "searched": xr.Variable("number", study.estimate.searched[: len(free)]),
        "covariance": xr.Variable(("number", "other"), covariance, {"long_name": "of searched numbers"}),
    }
    for name in ("value", "uncertainty", "low", "high", "start"):
        contents[name] = xr.Variable("number", table[name].to_numpy(float), {"long_name": name})
    if study.samples is not None:
        contents["samples"] = xr.Variable(("draw", "number"), study.samples.to_numpy(float), {"long_name": "posterior samples"})
    for one in study.profiles:
        contents[f"profile_{one.name}"] = xr.Variable(f"place_{one.name}", one.values)
        contents[f"rise_{one.name}"] = xr.Variable(f"place_{one.name}", one.rise, {"long_name": "-2 ln likelihood above the least"})
    return contents


@styled
def draw_inference(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw record and best run, the residual and the slip rate below each other, and beside them pairs of numbers."""
    paired = _paired(dataset)
    count = max(len(paired) - 1, 0)
    shown = (
        RECORD_PANELS
        if "feature" not in dataset
        else {name: name_of(name, dataset.attrs["load_unit"]) for name in _features(dataset)}
    )
    figure = sheet((7.2 if count else 5.0, max(5.4, 1.2 * len(shown) + 1.0)), **place)
    axes: Any = figure.subplot_mosaic(_layout(list(shown), count), width_ratios=[2.2, *[1.0] * count] if count else None)
    if "feature" in dataset:
        _draw_features(axes, dataset)
    else:
        _draw_curves(axes, dataset, str(dataset["quantity"].values[0]))
    _draw_pairs(axes, dataset, paired)
    last = {"00": "pairs, 95 %"} if count else {}
    letter_panels([axes[name] for name in (*shown, *last)], [*shown.values(), *last.values()])
    letter = f"({string.ascii_lowercase[len(shown)]}) "
    add_legend(next(iter(axes.values())), [*_marks(dataset), *(_pair_marks(dataset, letter) if count else [])])
    set_title(figure, str(dataset.attrs["title"]))
    return figure


@styled
def draw_features(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw each feature of the slip events of the record, its mean, and that of the best run."""
    shown = _features(dataset)
    figure = sheet((6.4, 1.2 * len(shown) + 1.0), **place)
    axes: Any = figure.subplot_mosaic([[name] for name in shown])
    _draw_features(axes, dataset)
    letter_panels([axes[name] for name in shown], [name_of(name, dataset.attrs["load_unit"]) for name in shown])
    add_legend(axes[shown[0]], _marks(dataset))
    return figure


@styled
def draw_curves(dataset: xr.Dataset, name: str, **place: Unpack[Place]) -> Figure:
    """Draw one quantity of the record with the best run, what is left of it, and the slip rate."""
    figure = sheet((6.4, 5.4), **place)
    axes: Any = figure.subplot_mosaic([["record"], ["residual"], ["rate"]])
    _draw_curves(axes, dataset, name)
    what, rate = (name_of(one, dataset.attrs["load_unit"]) for one in (name, "slip_rate"))
    letter_panels(list(axes.values()), [f"{what}, record and best run", "residual", f"{rate} of the best run"])
    add_legend(axes["record"], _marks(dataset))
    return figure


@styled
def draw_pairs(dataset: xr.Dataset, most: int = MOST_PAIRED, **place: Unpack[Place]) -> Figure | None:
    """Draw each pair of the first numbers that are determined, of `most` of them; None if there is no pair."""
    paired = _paired(dataset, most)
    count = len(paired) - 1
    if count < 1:
        return None
    figure = sheet((1.6 + 1.5 * count, 1.2 + 1.4 * count), **place)
    axes: Any = figure.subplot_mosaic([[f"{i}{j}" if j <= i else "." for j in range(count)] for i in range(count)])
    _draw_pairs(axes, dataset, paired)
    add_legend(axes["00"], _pair_marks(dataset))
    return figure


def _draw_curves(axes: Mapping[str, Axes], dataset: xr.Dataset, name: str) -> None:
    """Draw in the panels "record", "residual" and "rate"."""
    unit, size = time_unit(float(np.nanmax(dataset["time"].values) - min(0.0, float(np.nanmin(dataset["time"].values)))))
    _draw_record(axes["record"], dataset, name, size)
    _draw_residual(axes["residual"], dataset, name, size)
    _draw_rate(axes["rate"], dataset, size)
    for row in ("record", "residual"):
        axes[row].sharex(axes["rate"])
        axes[row].tick_params(labelbottom=False)
    axes["rate"].ticklabel_format(axis="x", useOffset=False, style="plain")
    axes["rate"].set_xlabel(f"time $t$ ({unit})")


def _draw_pairs(axes: Mapping[str, Axes], dataset: xr.Dataset, paired: list[int]) -> None:
    """Draw in the panels "00", "10", "11" and so on; the first digit is the row."""
    count = len(paired) - 1
    for i in range(count):
        for j in range(i + 1):
            _draw_pair(axes[f"{i}{j}"], dataset, paired[j], paired[i + 1], (i == count - 1, j == 0))


def _layout(rows: list[str], count: int) -> Any:
    """Return the places of the panels: some below each other, and a triangle of pairs beside them."""
    high = math.lcm(len(rows), max(count, 1))  # so that rows of both sides have a common height
    wide = []
    for k in range(high):
        i = k * count // high
        wide.append([rows[k * len(rows) // high], *(f"{i}{j}" if j <= i else "." for j in range(count))])
    return wide


def _paired(dataset: xr.Dataset, most: int = MOST_PAIRED) -> list[int]:
    """Return the indices of the numbers that are drawn against each other: shared ones that the record determines."""
    known = np.isfinite(dataset["uncertainty"].values) & (dataset["shared"].values == 1)
    return np.flatnonzero(known).tolist()[:most]


def _features(dataset: xr.Dataset) -> list[str]:
    """Return the names of the features, each once."""
    return [str(name) for name in dict.fromkeys(dataset["feature"].values.tolist())]


def _draw_features(axes: Mapping[str, Axes], dataset: xr.Dataset) -> None:
    """Draw each feature in the panel of its name: all events, the mean of each part of the record, and the run."""
    time_name, size = time_unit(float(np.nanmax(dataset["time"].values)))
    names = _features(dataset)
    for name in names:
        letter, si = QUANTITIES[name].symbol, si_unit(name, dataset.attrs["load_unit"])
        of = dataset["quantity"].values == name
        unit, scale = readable_unit(si, dataset["data"].values[of])
        for row in np.flatnonzero(dataset["feature"].values == name).tolist():
            chosen = of & (dataset["part"].values == dataset["part_of_mean"].values[row])
            time = dataset["time"].values[chosen] / size
            mean, error, run = (float(dataset[what].values[row]) / scale for what in ("mean", "error", "run"))
            dots = 3 if chosen.sum() > FEW_EVENTS else 6
            axes[name].plot(time, dataset["data"].values[chosen] / scale, ".", color=SKY, markersize=dots, rasterized=True)
            axes[name].fill_between(time[[0, -1]], mean - TWO * error, mean + TWO * error, color=BLUE, alpha=0.4, linewidth=0.0)
            axes[name].plot(time[[0, -1]], [run, run], color=INK, linewidth=1.0)
        axes[name].set_ylabel(f"${letter}$" if unit == "1" else f"${letter}$ ({unit})")
        axes[name].ticklabel_format(useOffset=False, style="plain")
        axes[name].sharex(axes[names[-1]])
        axes[name].tick_params(labelbottom=name == names[-1])
    axes[names[-1]].set_xlabel(f"time $t$ ({time_name})")


def _draw_record(axes: Axes, dataset: xr.Dataset, name: str, size: float) -> None:
    si = si_unit(name, dataset.attrs["load_unit"])
    of = dataset["quantity"].values == name
    unit, scale = readable_unit(si, dataset["data"].values[of])
    dots = 2 if of.sum() > MANY else 5
    for part in np.unique(dataset["part"].values):
        chosen = of & (dataset["part"].values == part)
        time = dataset["time"].values[chosen] / size
        axes.plot(time, dataset["data"].values[chosen] / scale, ".", color=SKY, markersize=dots, rasterized=True)
        axes.plot(time, dataset["model"].values[chosen] / scale, color=INK, linewidth=1.0)
    left_out = of & (dataset["fitted"].values == 0)
    if left_out.any():
        times = dataset["time"].values[left_out] / size
        axes.axvspan(times.min(), times.max(), color=GREY, alpha=0.15, linewidth=0.0, zorder=0)
    axes.set_ylabel(curve_label(name, unit))


def _draw_residual(axes: Axes, dataset: xr.Dataset, name: str, size: float) -> None:
    letter, si = QUANTITIES[name].symbol, si_unit(name, dataset.attrs["load_unit"])
    of = dataset["quantity"].values == name
    rest = dataset["residual"].values[of]
    unit, scale = readable_unit(si, rest)
    power = 10.0 ** math.floor(math.log10(np.nanmax(np.abs(rest)) or 1.0)) if si == "1" else 1.0
    axes.plot(
        dataset["time"].values[of] / size,
        rest / scale / power,
        ".",
        color=BLUE,
        markersize=1.5 if of.sum() > MANY else 4,
        rasterized=True,
    )
    zero_line(axes)
    digits = f"$10^{{{round(math.log10(power))}}}$" if si == "1" else unit
    axes.set_ylabel(f"${letter}$, measured\nminus run ({digits})")


def _draw_rate(axes: Axes, dataset: xr.Dataset, size: float) -> None:
    rate = dataset["slip_rate"].values
    positive = rate[np.isfinite(rate) & (rate > 0.0)]
    log = bool(positive.size and spans_decades(positive))
    unit, scale = readable_unit(dataset["slip_rate"].attrs["units"], rate[np.isfinite(rate)], log=log)
    shown = np.where(rate > 0.0, rate, np.nan) if log else rate
    axes.plot(dataset["run_time"].values / size, shown / scale, color=VERMILLION, linewidth=1.0)
    if log:
        axes.set_yscale("log")
        axes.set_ylim(bottom=max(float(positive.min()), 1e-12 * float(positive.max())) / scale)
    axes.set_ylabel(curve_label("slip_rate", unit))


def _draw_pair(axes: Axes, dataset: xr.Dataset, x: int, y: int, edges: tuple[bool, bool]) -> None:
    """Draw samples of two numbers, and the ellipse of 95 % that the curvature gives; `edges` tells if labels are due."""
    units = [readable_unit(str(dataset["unit"].values[i]), dataset["value"].values[i]) for i in (x, y)]
    if "samples" in dataset:
        drawn = dataset["samples"].values[:, [x, y]] / [units[0][1], units[1][1]]
        axes.plot(
            drawn[:: -(-len(drawn) // 2000)].T[0],
            drawn[:: -(-len(drawn) // 2000)].T[1],
            ".",
            color=SKY,
            markersize=1,
            rasterized=True,
        )
    values, vectors = np.linalg.eigh(dataset["covariance"].values[np.ix_([x, y], [x, y])])
    angle = np.linspace(0.0, 2.0 * math.pi, 200)
    ring = vectors @ (np.sqrt(np.maximum(values, 0.0))[:, None] * JOINT * np.array([np.cos(angle), np.sin(angle)]))
    ends = [_natural(dataset, i, ring[k]) / units[k][1] for k, i in enumerate((x, y))]
    axes.plot(*ends, color=BLUE, linewidth=1.0)
    axes.plot(*(dataset["value"].values[i] / units[k][1] for k, i in enumerate((x, y))), "+", color=INK, markersize=5)
    axes.xaxis.set_major_locator(MaxNLocator(2))
    axes.yaxis.set_major_locator(MaxNLocator(3))
    axes.ticklabel_format(useOffset=False, style="plain")
    labels = [_label(dataset, i, units[k][0]) for k, i in enumerate((x, y))]
    below, beside = edges
    axes.tick_params(labelbottom=below, labelleft=beside, labelsize=6, axis="both")
    if below:
        axes.tick_params(axis="x", rotation=30)
        axes.set_xlabel(labels[0])
    if beside:
        axes.set_ylabel(labels[1])


def _natural(dataset: xr.Dataset, i: int, away: Any) -> Any:
    """Return values (SI) some way from the best searched number."""
    at = float(dataset["searched"].values[i])
    return np.exp(at + away) if dataset["logarithmic"].values[i] else (at + away) * float(dataset["scale"].values[i])


def _label(dataset: xr.Dataset, i: int, unit: str) -> str:
    """Return the symbol of a number, or its last name, with its unit."""
    name, meaning = str(dataset["number"].values[i]), str(dataset["meaning"].values[i])
    short = symbol(name, meaning) or name.rpartition(".")[2].replace("_", " ")
    short = short if len(short) < 14 else parameter_name(name, "")
    return short if unit == "1" else f"{short} ({unit})"


def _marks(dataset: xr.Dataset) -> list[Artist]:
    marks: list[Artist] = [
        Line2D([], [], color=SKY, linestyle="none", marker="o", markersize=3, label="measured"),
        Line2D([], [], color=INK, label="best run"),
    ]
    if "feature" in dataset:
        marks.insert(1, Patch(color=BLUE, alpha=0.4, linewidth=0.0, label="mean of the record, 95 %"))
    if (dataset["fitted"].values == 0).any():
        marks.append(Patch(color=GREY, alpha=0.15, linewidth=0.0, label="left out, predicted"))
    return marks


def _pair_marks(dataset: xr.Dataset, panel: str = "") -> list[Artist]:
    marks: list[Artist] = [Line2D([], [], color=BLUE, label=f"{panel}from the curvature")]
    if "samples" in dataset:
        marks.append(Line2D([], [], color=SKY, linestyle="none", marker=".", label=f"{panel}samples"))
    return marks
