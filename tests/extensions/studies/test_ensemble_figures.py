"""The figure of an ensemble."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.figures.style import BLUE, image
from tests.core.figures.legible import LAW, SLAB

pytestmark = pytest.mark.usefixtures("closed_figures")


def test_an_ensemble_draws_what_members_share_and_how_they_separate() -> None:
    study = ss.studies.ensemble(
        ss.Problem(SLAB, LAW, pull_rate=0.1, initial_excess=1.0), 700 * SLAB.two_way_time, members=3, size=1e-4
    )
    figure = study.plot()
    lines, growth = figure.axes
    blue = [line for line in lines.lines if line.get_color() == BLUE]
    assert [len(line.get_xdata()) for line in blue] == [len(study.table), *study.has.sum(axis=1)]
    assert sum(len(line.get_xdata()) for line in lines.lines if line.get_marker() == "|") == sum(map(len, study.catalogues))
    assert growth.get_yscale() == "log"
    measured = next(line for line in growth.lines if line.get_label() == "measured")
    assert list(measured.get_ydata()) == [1.0, *study.growth.growth]
    assert lines.get_xlim() == growth.get_xlim()
    for axes in figure.axes:
        assert axes.get_title(loc="left")
        assert axes.has_data()
    key = [text.get_text() for text in figure.legends[0].get_texts()]
    assert {"(b) measured, median", "(b) measured, least to most", "(b) running maximum of the prediction"} <= set(key)
    assert ("events not shared" in key) == (study.table.members.min() < 3)


@pytest.mark.slow
def test_an_ensemble_at_rest_or_of_one_event_can_be_drawn() -> None:
    for excess, duration in ((-1e6, 100.0), (-1e6, 1.0), (0.0, 1.0)):
        study = ss.studies.ensemble(ss.Problem(SLAB, LAW, pull_rate=0.0, initial_excess=excess), duration, members=2)
        assert image(study.plot(), "png", 50.0)
    assert study.catalogues[0].empty
