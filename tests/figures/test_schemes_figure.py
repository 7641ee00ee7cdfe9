"""The figure of schemes: it draws each scheme, and at most four curves beside the exact solution of each rule."""

from __future__ import annotations

import stickslip as ss
from stickslip.figures.studies import schemes as figure

NAMES = ["characteristics", "theta", "backward-euler", "newmark", "hht"]


def test_the_figure_has_errors_of_all_schemes_and_curves_of_four() -> None:
    study = ss.studies.schemes("fig4-loop", scheme=NAMES, cells=[20, 40])
    dataset = figure.data(study)
    drawn = figure.draw(dataset)
    errors, slip, rate = drawn.axes
    assert [len(line.get_xdata()) for line in errors.lines] == [2] * 5
    assert dataset.attrs["runs"] == [f"{name}, 40 cells" for name in NAMES[:4]]
    assert len(dataset.attrs["rules"]) == len(study.paths.groups()) == 4
    assert [len(panel.lines) for panel in (slip, rate)] == [9, 9]  # four schemes, four rules, zero
    assert dataset.scheme0_error.values.tolist() == study.table.slip_error[:2].tolist()
