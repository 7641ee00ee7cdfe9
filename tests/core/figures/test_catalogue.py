"""The figure of a catalogue shows its numbers, in units in which they can be read."""

from __future__ import annotations

import re
import warnings

import matplotlib as mpl
import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.figures.runs import catalogue
from stickslip.figures.runs.run import draw_run
from stickslip.figures.style import time_unit
from tests.core.figures.legible import illegible
from tests.problems import SLAB, rate_law_slab

UNIT = re.compile(r"\((year|day|s|ms|µs|m|mm|µm|nm)\)$")


@pytest.fixture(scope="module")
def cycles() -> ss.Solution:
    return ss.simulate("cycles-block")


def panel(figure: Figure, name: str) -> mpl.axes.Axes:
    return next(axes for axes in figure.axes if axes.get_title(loc="left").startswith(f"({name})"))


def test_every_axis_has_its_unit(cycles: ss.Solution) -> None:
    figure = catalogue.draw_catalogue(catalogue.catalogue_shown(cycles))
    assert len(figure.axes) == 7
    texts = [text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel())]
    assert all(UNIT.search(text) or "events" in text for text in texts), texts
    assert [panel(figure, name).get_xlabel().split()[-1] for name in "bcd"] == ["(year)", "(s)", "(ms)"]


def test_the_figure_shows_the_numbers_of_the_catalogue(cycles: ss.Solution) -> None:
    events = cycles.events
    figure = catalogue.draw_catalogue(catalogue.catalogue_shown(cycles))
    marks, ring = panel(figure, "a").lines
    assert panel(figure, "a").get_ylabel() == "slip (mm)"
    assert marks.get_xydata() == pytest.approx(np.column_stack([events.start / ss.YEAR, 1e3 * events.slip]), rel=1e-14)
    assert ring.get_xydata()[0] == pytest.approx([events.start.iloc[-1] / ss.YEAR, 1e3 * events.slip.iloc[-1]], rel=1e-14)
    assert panel(figure, "f").patches[0].get_data().values.sum() == len(events) - 1
    points = panel(figure, "g").lines[0].get_xydata()
    assert points == pytest.approx(np.full((len(events) - 2, 2), events.recurrence[1] / ss.YEAR), rel=1e-9)
    time, slip = panel(figure, "c").lines[0].get_xydata().T
    assert slip[-1] == pytest.approx(1e3 * events.slip.iloc[-1], rel=1e-9)  # mm
    assert time[slip < 0.999 * slip[-1]].max() < events.duration.iloc[-1]


def test_another_event_can_be_chosen(cycles: ss.Solution) -> None:
    assert catalogue.catalogue_shown(cycles, 2).chosen == 2
    with pytest.raises(ss.InputError, match="no event 99"):
        catalogue.catalogue_shown(cycles, 99)


def test_a_late_event_is_drawn_sharply() -> None:
    """Milliseconds after 468 years, where seconds are 2e-6 apart: a straight line, to rounding."""
    shown = catalogue.catalogue_shown(ss.simulate(rate_law_slab(), 480 * ss.YEAR))
    time, slip = shown.zooms["close"]
    late = time > 0.0
    assert shown.chosen == 1
    assert slip[late] / time[late] == pytest.approx(np.full(late.sum(), 4.10204082), rel=1e-8, abs=0.0)
    assert (slip[time < 0.0] == 0.0).all()


@pytest.mark.parametrize(("duration", "panels"), [(12.0, "abcd"), (480 * ss.YEAR, "abcdef")])
def test_few_events_have_no_panels_without_data(duration: float, panels: str) -> None:
    figure = catalogue.draw_catalogue(catalogue.catalogue_shown(ss.simulate(rate_law_slab(), duration)))
    assert [axes.get_title(loc="left")[1] for axes in figure.axes] == list(panels)
    for axes in figure.axes:
        assert axes.has_data()
    key = [text.get_text()[1] for text in figure.legends[0].get_texts()]
    assert set(key) <= set(panels)


def test_no_events_cannot_be_drawn() -> None:
    still = ss.simulate(ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), initial_load=1e6), 10.0)
    with pytest.raises(ss.InputError, match="no slip event"):
        catalogue.catalogue_shown(still)


def test_wide_ranges_are_logarithmic() -> None:
    run = ss.simulate(rate_law_slab(selection="maximal"), 380 * ss.YEAR)
    figure = catalogue.draw_catalogue(catalogue.catalogue_shown(run))
    assert panel(figure, "f").get_xscale() == panel(figure, "g").get_yscale() == "log"
    assert panel(figure, "e").get_xscale() == "linear"


def test_a_window_is_drawn_in_local_time() -> None:
    figure = draw_run(ss.simulate(rate_law_slab(), 480 * ss.YEAR).window(1))
    assert figure.axes[-1].get_xlabel() == "time since the event began (s)"
    assert figure.axes[0].get_ylabel() == r"slip in the event $\Delta u$ (m)"
    time, slip = figure.axes[0].lines[0].get_xydata().T
    assert (time[0], slip[0]) == (pytest.approx(-0.1 * 5.714285714, rel=1e-9), 0.0)


@pytest.mark.parametrize(
    ("span", "unit"), [(3e9, "year"), (9e4, "day"), (2e4, "s"), (0.6, "s"), (0.4, "ms"), (2e-3, "ms"), (3e-4, "µs")]
)
def test_time_is_shown_in_a_unit_that_can_be_read(span: float, unit: str) -> None:
    assert time_unit(span)[0] == unit


# ---- sizes, and catalogues of all kinds ------------------------------------------------------------------------------------------


def table(starts: object, slips: object, *, cut: bool = False) -> pd.DataFrame:
    """Return a catalogue of events of no time at these times (s) with these slips (m); `cut` says that the last is cut off."""
    times, slip = np.asarray(starts, float), np.asarray(slips, float)
    ends = np.where(np.arange(len(times)) == len(times) - 1, np.nan, times) if cut else times
    return pd.DataFrame({"start": times, "end": ends, "slip": slip, "recurrence": np.diff(times, prepend=np.nan)})


CATALOGUES = {
    "one event at the start": table([0.0], [1.0]),
    "one event": table([3e7], [1.0]),
    "two events": table([0.0, 5.0], [1.0, 2.0]),
    "two events, the last cut off": table([0.0, 5.0], [1.0, 2.0], cut=True),
    "the same again and again": table(1e8 * np.arange(9), np.full(9, 0.16)),
    "events without slip": table([0.0, 1.0, 2.0], [0.0, 0.0, 0.0]),
    "two events at one time": table([5.0, 5.0, 5.0], [1.0, 1.0, 1.0]),
    "many decades": table(np.cumsum(np.geomspace(1e-3, 1e9, 60)), np.geomspace(1e-9, 10.0, 60)),
    "thousands": table(3e7 * np.arange(3000), 1.0 + np.arange(3000) % 7),
}
SIZES = [None, "single column", "3.4 x 3 in", "16 x 10 cm"]


@pytest.mark.sampled(every=58)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("kind", CATALOGUES)
def test_a_catalogue_without_its_run_is_legible_in_any_size(kind: str, size: str | None) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = catalogue.draw_catalogue(catalogue.ShownCatalogue(CATALOGUES[kind], kind), size=size)
        assert illegible(figure) == []


@pytest.mark.sampled(every=18)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("scenario", ["cycles-block", "fig6-slab", "second-event-maximal", "second-event-minimal"])
def test_a_catalogue_with_its_run_is_legible_in_any_size(scenario: str, size: str | None) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        figure = catalogue.draw_catalogue(catalogue.catalogue_shown(ss.simulate(scenario)), size=size)
        assert illegible(figure) == []


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("size", "titles"),
    [
        ("7.2 x 8 in", ["slip events", "slip in the run", "one event", "its start", "slips", "recurrence times", "return map"]),
        ("7.2 x 3.5 in", ["slip events", "slips", "recurrence times", "return map"]),
        ("3.5 x 8 in", ["slip events", "slip in the run", "one event", "its start", "slips", "recurrence times", "return map"]),
        ("3.5 x 4.2 in", ["slip events", "slip in the run", "slips", "recurrence times", "return map"]),
        ("3.5 x 3 in", ["slip events", "slips", "recurrence times"]),
        ("3.5 x 1.7 in", ["slip events"]),
    ],
)
def test_a_low_figure_leaves_out_zooms_first(size: str, titles: list[str], cycles: ss.Solution) -> None:
    figure = catalogue.draw_catalogue(catalogue.catalogue_shown(cycles), size=size)
    found = [" ".join(axes.get_title(loc="left").split()) for axes in figure.axes]
    marks = [f"({letter}) " for letter in "abcdefg"[: len(titles)]] if len(titles) > 1 else [""]
    assert sorted(found) == [mark + title for mark, title in zip(marks, titles, strict=True)]
    key = [re.findall(r"\((\w)\)", text.get_text()) for text in figure.legends[0].get_texts()]
    assert {letter for letters in key for letter in letters} <= set("abcdefg"[: len(titles)])


@pytest.mark.slow
def test_illegible_texts_are_noticed(cycles: ss.Solution) -> None:
    figure = catalogue.draw_catalogue(catalogue.catalogue_shown(cycles))
    assert illegible(figure) == []
    figure.axes[1].set_title("a title that is far too long for a panel beside two others", loc="left")
    figure.axes[0].set_xticks([1.0, 1.1], ["1.0", "1.1"])
    assert any("'1.0' and '1.1' cover each other" in line for line in illegible(figure))
    assert any("a title" in line for line in illegible(figure))
