"""Figure of a catalogue of slip events: their times, one of them from years down to milliseconds, and their distributions."""

from __future__ import annotations

import math
import re
import string
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from stickslip.figures.panels import add_legend, count_ticks, letter_panels, set_scale, set_title, zero_line
from stickslip.figures.sheet import sheet, size_of
from stickslip.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    SPAN_OF_LOGARITHM,
    VERMILLION,
    curve_label,
    spans_decades,
    styled,
    time_unit,
    title_of,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import name_of, readable_unit, si_unit
from stickslip.foundation.place import Place
from stickslip.solution import Curve, Solution, last_large_event
from stickslip.solution.observables import is_followed, that_count
from stickslip.solution.observables.predictability import predictability

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

LAST_ZOOM = 1e-3
"""The last zoom shows this share of the event's duration after its start, and a quarter of that before it."""
ZOOMS: dict[str, tuple[str, Curve, str]] = {
    "run": ("slip in the run", "slip", "time $t$"),
    "window": ("one event", "event_slip", "since its start"),
    "close": ("its start", "event_slip", "since its start"),
}
"""Title, curve and name of the time axis of the three zooms, by what they show."""
TITLES_OF_ZOOMS = {"A": "slip events", **dict(zip("BCD", (title for title, *_ in ZOOMS.values()), strict=True))}
TITLES_OF_ZOOMS |= {"E": "slips", "F": "recurrence times", "G": "return map"}
"""Titles of the panels, by their names in the mosaic: the time line, the zooms, and the distributions."""
WHOLE_WIDTH = 7.0
"""Width (inches) of a figure below which it is narrow: letters are smaller, and labels have several lines."""
THREE, TWO = 5.4, 3.0
"""A figure of these widths (inches) or more has three, or two, panels and their labels side by side."""
ROW, KEY = 1.1, 0.75
"""Heights (inches) of the lowest row of panels with its labels, and of title and key together."""
HELD = "\0"
"""Stands for a space where no line may end."""
LETTERS_OF_LINE = 17
"""Number of letters in a line of a title or a label of a panel in a narrow figure."""


@dataclass(frozen=True)
class ShownCatalogue:
    """What the figure shows: a table of slip events (SI) of a body whose loads have a unit and, if its run is there, `zooms`.

    They are times (s) and slips (m) of the run, of the event `chosen`, and of the start of that, the last two in s since the event
    began. `horizon` is that of predictability (s; inf if there is none or it is not known).
    """

    table: pd.DataFrame
    heading: str = ""
    load_unit: str = "Pa"
    zooms: Mapping[str, tuple[Floats, Floats]] = field(default_factory=dict)
    chosen: int | None = None
    horizon: float = math.inf

    @property
    def length(self) -> str:
        """The SI unit of slip."""
        return si_unit("slip", self.load_unit)

    @property
    def whole_slip(self) -> Floats:
        """The slips of the events that are over."""
        return that_count(self.table, "slip")

    def of(self, column: str) -> Floats:
        """Return a column."""
        return self.table[column].to_numpy(float)


def catalogue_shown(solution: Solution, event: int | None = None) -> ShownCatalogue:
    """Return what is shown of a run.

    `event` is the row number in `solution.events`; negative ones count from the last. By default it is the last event whose slip is
    at least 99 % of the largest. Raises InputError if the run has no slip event, or not the one asked for.
    """
    table = solution.events
    if table.empty:
        raise InputError("catalogue figure: the run has no slip event")
    chosen = last_large_event(table.slip.to_numpy(float)) if event is None else event
    window = solution.window(chosen)
    lasting = window.shown[1] / 1.1
    near = solution.window(chosen, before=0.25 * LAST_ZOOM * lasting, after=LAST_ZOOM * lasting)
    zooms = {name: run.curve(ZOOMS[name][1]) for name, run in (("run", solution), ("window", window), ("close", near))}
    # After the horizon only statistics mean anything.
    horizon = predictability(solution).horizon if is_followed(solution.problem) else math.inf
    return ShownCatalogue(table, title_of(solution), solution.problem.load_unit, zooms, chosen % len(table), horizon)


@styled
def draw_catalogue(shown: ShownCatalogue, **place: Unpack[Place]) -> Figure:
    """Draw the time line, slip against time in three zooms, the distributions of slip and recurrence time, and the return map.

    A catalogue without its run has no zooms, one of one event no distributions, and one of two no return map. In a narrow figure
    less than three panels stand side by side, and what a low one has no room for is left out, the zooms first.
    """
    count, recurrence = len(shown.table), shown.of("recurrence")
    recurrence = recurrence[np.isfinite(recurrence)]
    distributions = "EFG"[: 0 if count == 1 else count]
    rows, usual = _rows("BCD" if shown.zooms else "", distributions[:3], **place)
    narrow = usual[0] < WHOLE_WIDTH
    figure = sheet(usual, **place)
    cells = math.lcm(*map(len, rows))
    axes = figure.subplot_mosaic(";".join("".join(name * (cells // len(row)) for name in row) for row in rows))
    letters = dict(zip(sorted(axes), string.ascii_lowercase, strict=False))
    _draw_time_line(axes["A"], shown, ring=bool({"C", "D"} & set(axes)))
    _draw_zooms(axes, shown)
    unit, size = time_unit(float(recurrence.max())) if len(recurrence) else ("s", 1.0)
    if "E" in axes:
        _draw_distribution(axes["E"], shown)
    if "F" in axes:
        _draw_recurrence(axes["F"], recurrence / size, unit, narrow=narrow)
    if "G" in axes:
        _draw_return_map(axes["G"], recurrence / size, unit)
    letter_panels((axes[name] for name in letters), (TITLES_OF_ZOOMS[name] for name in letters))
    for name in letters if narrow else ():
        _make_small(axes[name], LETTERS_OF_LINE if name != "A" else 2 * LETTERS_OF_LINE)
    add_legend(axes["A"], _marks(shown, letters))
    set_title(figure, f"{shown.heading}: {count} slip event{'s' if count > 1 else ''}".removeprefix(": "))
    return figure


def _rows(zooms: str, distributions: str, **place: Unpack[Place]) -> tuple[list[str], tuple[float, float]]:
    """Return the panels of each row of a figure that has room for them, and the usual size (inches) of a figure of its width."""
    width, _ = size_of((7.2, 1.0), **place)
    side_by_side = 3 if width >= THREE else 2 if width >= TWO else 1

    def arranged(panels: str) -> list[str]:
        return [panels[k : k + side_by_side] for k in range(0, len(panels), side_by_side)]

    def in_groups(panels: str) -> list[str]:
        return [row for group in (zooms, distributions) if (row := "".join(name for name in group if name in panels))]

    arrange = in_groups if side_by_side == 3 else arranged
    usual = (width, (2.3 if side_by_side == 3 else 1.8) * (1 + len(arrange(zooms + distributions))) + 0.6)
    room = max(int((size_of(usual, **place)[1] - KEY) / ROW) - 1, 0)
    kept = distributions + zooms
    while len(arrange("".join(sorted(kept)))) > room:
        kept = kept[:-1]
    return ["A", *arrange("".join(sorted(kept)))], usual


def _make_small(axes: Axes, line: int) -> None:
    """Give a panel of a narrow figure smaller letters, and titles and labels in lines of so many letters."""
    axes.set_title(_in_lines(axes.get_title(loc="left"), line - 3), loc="left", fontsize=8.5, pad=4)
    axes.set_xlabel(_in_lines(axes.get_xlabel(), line), fontsize=8)
    axes.set_ylabel(_in_lines(axes.get_ylabel(), LETTERS_OF_LINE - 2), fontsize=8)
    axes.tick_params(labelsize=7.5)
    for text in axes.texts:
        text.set_fontsize(7)


def _in_lines(text: str, length: int) -> str:
    """Return a text in lines of so many letters; none begins inside a formula."""
    joined = re.sub(r"\$[^$]*\$", lambda found: found[0].replace(" ", HELD), text)
    return textwrap.fill(joined, length, break_long_words=False).replace(HELD, " ")


def _marks(shown: ShownCatalogue, letters: Mapping[str, str]) -> list[Artist]:
    """Return the entries of the key for the panels that are drawn, which have these letters."""
    point: Any = {"linestyle": "none", "marker": "o"}
    event = "(a) slip event" if len(letters) > 1 else "slip event"  # one panel has no letter
    marks: list[Artist] = [Line2D([], [], color=BLUE, markersize=3, label=event, **point)]
    if (shown.of("slip") < 0.0).any():
        back = {"markersize": 3, "markerfacecolor": "white", "color": BLUE}
        marks.append(Line2D([], [], label=event.replace("slip event", "event that slips back"), **point | back))
    closer = ", ".join(f"({letters[name]})" for name in "CD" if name in letters)
    if closer:
        ring = {"color": VERMILLION, "markersize": 6, "markerfacecolor": "none"}
        marks.append(Line2D([], [], label=f"(a) event of {closer}", **point | ring))
    if "B" in letters:
        marks.append(Line2D([], [], color=VERMILLION, linewidth=0.8, label=f"({letters['B']}) its time"))
    if shown.zooms and shown.horizon < shown.zooms["run"][0][-1]:
        marks.append(Patch(color=GREY, alpha=0.15, linewidth=0.0, label="(a) beyond the predictability horizon"))
    if "F" in letters:
        marks.append(Line2D([], [], color=VERMILLION, linewidth=1.0, linestyle="--", label=f"({letters['F']}) mean"))
    if "G" in letters:
        marks.append(Line2D([], [], color=GREY, linewidth=0.8, label=f"({letters['G']}) equal times"))
    return marks


def _draw_time_line(axes: Axes, shown: ShownCatalogue, *, ring: bool) -> None:
    signed, starts = shown.of("slip"), shown.of("start")
    wide, back = spans_decades(np.abs(signed)), signed < 0.0
    slip = np.abs(signed) if wide else signed  # a logarithmic axis has no place for a sign: open circles tell it
    last = float((shown.zooms["run"][0] if shown.zooms else starts)[-1])
    unit, size = time_unit(last)
    length, metres = readable_unit(shown.length, slip, log=wide)
    start, end = starts / size, last / size
    low = 0.5 * slip.min() / metres if wide else 0.0
    axes.vlines(start, low, slip / metres, color=BLUE, linewidth=0.9)
    axes.plot(start, slip / metres, "o", color=BLUE, markersize=3)
    if back.any():
        axes.plot(start[back], slip[back] / metres, "o", color=BLUE, markersize=3, markerfacecolor="white")
    if shown.chosen is not None:
        if ring:
            at = start[shown.chosen], slip[shown.chosen] / metres
            axes.plot(*at, "o", color=VERMILLION, markersize=6, markerfacecolor="none")
        if (horizon := shown.horizon / size) < end:
            axes.axvspan(horizon, 1.02 * end, color=GREY, alpha=0.15, linewidth=0.0)
    set_scale(axes, "y", wide)
    axes.margins(y=0.12)  # no point is cut by the upper edge of a low panel
    if wide or not back.any():
        axes.set_ylim(bottom=low)
    else:
        zero_line(axes)
    if end > 0.0:  # else one event at 0 s is all there is
        axes.set_xlim(-0.02 * end, 1.02 * end)
    axes.set(xlabel=curve_label("time", unit), ylabel=f"{name_of('slip', shown.load_unit)} ({length})")


def _draw_zooms(panels: Mapping[str, Axes], shown: ShownCatalogue) -> None:
    for panel, (name, (_, curve, clock)) in zip("BCD", ZOOMS.items(), strict=True):
        if panel not in panels:
            continue
        axes = panels[panel]
        time, slip = shown.zooms[name]
        (unit, size), (length, metres) = time_unit(float(np.ptp(time))), readable_unit(shown.length, np.ptp(slip))
        axes.plot(time / size, slip / metres, color=GREEN)
        if name == "run":
            axes.axvline(float(shown.of("start")[shown.chosen]) / size, color=VERMILLION, linewidth=0.8, zorder=0)
        axes.set(xlabel=f"{clock} ({unit})", ylabel=curve_label(curve, length, shown.load_unit))
        axes.xaxis.set_major_locator(MaxNLocator(4))
        zero_line(axes)


def _draw_distribution(axes: Axes, shown: ShownCatalogue) -> None:
    slip, name = shown.whole_slip, name_of("slip", shown.load_unit)
    many, wide = len(slip) > SPAN_OF_LOGARITHM, spans_decades(slip)
    unit, size = readable_unit(shown.length, slip, log=wide)
    ordered = np.sort(slip) / size  # sizes, in either direction
    smallest = ordered[0] if wide else 0.0
    axes.step([smallest, *ordered, ordered[-1]], [len(slip), *range(len(slip), 0, -1), 1 if many else 0], where="pre", color=BLUE)
    set_scale(axes, "x", wide)
    set_scale(axes, "y", many)
    if not many:
        axes.set_ylim(bottom=0.0)
        count_ticks(axes)
    if not wide and ordered[-1] > 0.0:
        axes.set_xlim(0.0, 1.15 * ordered[-1])
    axes.set(xlabel=f"{name} $x$ ({unit})", ylabel=f"events with {name} ≥ $x$")


def _draw_recurrence(axes: Axes, times: Floats, unit: str, *, narrow: bool) -> None:
    """Draw a histogram of recurrence times, given in `unit`, with their mean and their coefficient of variation."""
    bins = min(max(int(np.sqrt(4 * len(times))), 5), 60)
    wide = spans_decades(times)
    edges = np.geomspace(times.min(), times.max(), bins + 1) if wide else np.linspace(0.0, 1.15 * times.max(), bins + 1)
    counts, _ = np.histogram(times, edges)
    axes.stairs(counts, edges, fill=True, color=BLUE)
    if counts.max() > SPAN_OF_LOGARITHM:
        axes.set(yscale="log", ylim=(0.5, (1000.0 if narrow else 10.0) * counts.max()))
    else:
        axes.set_ylim(0.0, (2.1 if narrow else 1.3) * counts.max())
        count_ticks(axes)
    axes.axvline(float(times.mean()), ymax=0.5 if narrow else 0.82, color=VERMILLION, linewidth=1.0, linestyle="--")
    set_scale(axes, "x", wide)
    axes.set(xlabel=f"recurrence time ({unit})", ylabel="number of events")
    if len(times) > 1 and times.max() > 0.0:
        variation = times.std(ddof=1) / times.mean()
        value = "< 0.001" if variation < 1e-3 else f"= {variation:.2g}"
        text = ("std. deviation", f"/ mean {value}")
        axes.text(0.03, 0.97, ("\n" if narrow else " ").join(text), transform=axes.transAxes, va="top", fontsize=8)


def _draw_return_map(axes: Axes, times: Floats, unit: str) -> None:
    axes.plot(times[:-1], times[1:], "o", color=INK, markersize=2.5, alpha=0.7)
    wide = spans_decades(times)
    limits = (0.5 * times.min(), 2.0 * times.max()) if wide else (0.0, 1.15 * (times.max() or 1.0))
    set_scale(axes, "xy", wide)
    axes.plot(limits, limits, color=GREY, linewidth=0.8, zorder=0)
    axes.set(xlim=limits, ylim=limits, aspect="equal", anchor="W")
    axes.set(xlabel=f"recurrence time ({unit})", ylabel=f"next one ({unit})")
