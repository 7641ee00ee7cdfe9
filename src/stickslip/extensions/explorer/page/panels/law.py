"""The panel of the friction law: the friction coefficient against slip or slip rate, and what the run visits of it."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.extensions.explorer.model.answer import Answer, LawPicture
from stickslip.extensions.explorer.page.components import paint
from stickslip.extensions.explorer.page.stage import Stage
from stickslip.extensions.explorer.page.view import Columns, LegendKey, Units, View, axis_label, limits
from stickslip.foundation.names import name_of, plain_symbol, readable_unit

TEXT_OF_LAW = "Friction law: friction coefficient against slip or slip rate"


def data_of(answer: Answer, units: Units) -> View:
    """Return the curve, where the run went, and the texts of the axes."""
    law = answer.law
    name, symbol = name_of(law.along, answer.motions[0].load_unit), plain_symbol(law.along)
    unit = unit_along(law, units)
    x = place(law, law.x, unit)
    least, most = float(np.nanmin(x)), float(np.nanmax(x))
    visited = _visited(law, x, unit)
    label, depends_on_slip = axis_label(name, symbol, unit[0]), answer.scenario.problem.friction.depends_on_slip
    main = answer.motions[0]
    along = main.slip if law.along == "slip" else main.slip_rate
    way = np.where(main.slip_rate < 0.0, -1.0, 1.0) if law.log else 1.0
    now = {"law_x": np.clip(place(law, along, unit), least, most), "law_y": way * main.traction / main.normal_load}
    return View(
        columns={"law": {"x": x, "y": law.coefficient}, "visited": visited, "motion": now},
        limits={"law_x": (least, most), "law_y": limits(law.coefficient, visited["y"])},
        labels={"axis:law_x@law": label, "axis:law_powers": label, "axis:law_y@law": "friction μ"},
        titles={"law": "Friction law at the slip of the start"} if depends_on_slip and law.along == "slip_rate" else {},
        keys={
            "law": (LegendKey(law.name, "ink"), LegendKey("visited by the run" if law.path is None else "path of the run", "law"))
        },
        hidden={"axis:law_x@law" if law.log else "axis:law_powers"},
    )


def _visited(law: LawPicture, x: Any, unit: tuple[str, float]) -> Columns:
    """Return the path of the run, or the part of the curve that the run passed through where that is its path."""
    if law.path is not None:
        return {"x": place(law, law.path[:, 0], unit), "y": law.path[:, 1]}
    low, high = place(law, law.visited, unit)
    inside = (x >= low) & (x <= high)
    ends = [np.interp(end, x, law.coefficient) for end in (low, high)]
    return {"x": np.concatenate([[low], x[inside], [high]]), "y": np.concatenate([ends[:1], law.coefficient[inside], ends[1:]])}


def unit_along(law: LawPicture, units: Units) -> tuple[str, float]:
    """Return the unit of the horizontal axis: that of the run, SI for powers of ten."""
    si, own = (units.slip_unit, units.slip) if law.along == "slip" else (f"{units.slip_unit}/s", units.rate)
    fits = 0.05 <= np.abs(law.x).max() / own[1] < 1e4  # the curve can reach much further than the run
    return (si, 1.0) if law.log else own if fits else readable_unit(si, law.x)


def place(law: LawPicture, values: Any, unit: tuple[str, float]) -> Any:
    """Return where values (SI) lie on the horizontal axis."""
    shown = np.asarray(values, float) / unit[1]
    return np.log10(np.maximum(np.abs(shown), 1e-300)) if law.log else shown


def plot(stage: Stage) -> Any:
    """Return the plot of the friction law."""
    drawn = stage.plot("law", "law_x", "law_y", TEXT_OF_LAW)
    stage.powers(drawn, "law_powers", "below")
    pinned = drawn.line("x", "y", source=stage.source("pinned_law", "x", "y"), line_width=2, line_alpha=0.8)
    paint(pinned.glyph, line_color="pin")
    paint(drawn.line("x", "y", source=stage.source("law", "x", "y"), line_width=1.6).glyph, line_color="ink")
    paint(drawn.line("x", "y", source=stage.source("visited", "x", "y"), line_width=3.2, line_cap="round").glyph, line_color="law")
    dot = drawn.scatter("x", "y", source=stage.source("now_law", "x", "y"), size=9, level="overlay")
    paint(dot.glyph, fill_color="cursor", line_color="card")
    return drawn
