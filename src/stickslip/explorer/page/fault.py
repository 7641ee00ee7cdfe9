"""The page of a fault in 2D: sliders for the numbers of its scenario, the slip rate over the contact and time, and the middle."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from html import escape
from typing import Any

import numpy as np
import panel as pn
from bokeh.models import ColumnDataSource, LogColorMapper
from bokeh.palettes import Magma256
from bokeh.plotting import figure

from stickslip.explorer.model.controls import unit_of
from stickslip.explorer.model.solve import Told
from stickslip.explorer.page.components import LIGHT, Markup, asset, style_sheet
from stickslip.explorer.page.explorer import Explorer
from stickslip.foundation.quantities import Quantity
from stickslip.run.planar_run import simulate_planar
from stickslip.scenarios.parameter_paths import values_in
from stickslip.scenarios.scenario import Scenario
from stickslip.solution.planar import PlanarSolution

REACH = (0.25, 2.5)
"""The ends of a slider, times the value with which the scenario began; a number that was 0 has no slider."""
RARE = ("nodes", "frames", "courant", "y[0]", "y[1]")
"""Ends of the names of numbers whose sliders are below the others."""
DARKEST = 1e-3
"""Smallest slip rate that has a colour, as a share of the largest one."""
WIDE = {"sizing_mode": "stretch_width"}


@dataclass(frozen=True)
class FaultSetting:
    """A scenario with a contact along a line, and the numbers (SI) that were given other values, by name."""

    scenario: Scenario
    values: Mapping[str, float] = field(default_factory=dict)

    def read(self) -> tuple[Scenario, tuple[str, ...]]:
        """Return the scenario with these values, and no doubts about it. Raises InputError, with one line."""
        return (self.scenario.with_values(self.values) if self.values else self.scenario), ()


@dataclass(frozen=True)
class FaultAnswer:
    """A run, and what to know about it, one line each."""

    run: PlanarSolution
    notes: tuple[str, ...] = ()


def solve_fault(scenario: Scenario, told: Told) -> FaultAnswer:
    """Run a scenario; `told` is called with lines on its progress, and may raise to end the run there."""
    contact = scenario.contact
    frames = None if contact is None else contact.frames
    run = simulate_planar(scenario.planar_slab, scenario.duration, frames=frames, progress=lambda report: told(str(report)))
    return FaultAnswer(run, tuple(run.sentences))


class FaultPage:
    """The parts of one page: `view` holds them all."""

    def __init__(self, explorer: Any) -> None:
        self._explorer, scenario = explorer, explorer.setting.scenario
        self.image = ColumnDataSource({"image": [], "x": [], "y": [], "dw": [], "dh": []})
        self.middle = ColumnDataSource({"time": [], "slip": [], "rate": []})
        self.colours = LogColorMapper(Magma256, low=1e-3, high=1.0, low_color="#000004", nan_color="#ECECEC")
        self.words = Markup(stylesheets=[style_sheet(":host") + asset("words.css")], **WIDE)
        map_plot = self._plot("along the contact y (km)", 340)
        painted = map_plot.image(source=self.image, color_mapper=self.colours)
        map_plot.x_range.range_padding = map_plot.y_range.range_padding = 0.0
        map_plot.add_layout(painted.construct_color_bar(title="slip rate (m/s)", padding=2), "right")
        plots = [map_plot]
        for name, text, role in (("slip", "slip (m)", "slip"), ("rate", "slip rate (m/s)", "rate")):
            plots.append(self._plot(text, 150))
            plots[-1].line("time", name, source=self.middle, line_width=2, color=LIGHT[role])
            plots[-1].x_range = map_plot.x_range
        plots[-1].xaxis.axis_label = "time (s); slip and slip rate are those in the middle"
        sliders = sorted(self._sliders(scenario), key=lambda one: one.label.partition(" (")[0].endswith(RARE))
        side = pn.Column(*sliders, width=330, height=720, scroll="y-auto")
        title = pn.pane.HTML(f"<h2>{escape(scenario.heading)}</h2><p>{escape(scenario.description)}</p>", **WIDE)
        body = pn.Column(self.words, *(pn.pane.Bokeh(plot, **WIDE) for plot in plots), **WIDE)
        self.view = pn.Column(title, pn.Row(side, body, **WIDE), **WIDE)
        for news, call in (("answer", self.show), ("fault", self.say), ("progress", self.say)):
            explorer.listen(news, call)

    @staticmethod
    def _plot(label: str, height: int) -> Any:
        return figure(height=height, y_axis_label=label, sizing_mode="stretch_width", toolbar_location=None, min_border_left=70)

    def _sliders(self, scenario: Scenario) -> list[Any]:
        """Return a slider for each number that is neither 0 nor infinite."""
        made = []
        for path, value in values_in(scenario):
            declared = path.declared
            if not isinstance(declared, Quantity) or not value or not math.isfinite(value):
                continue
            unit, size = unit_of(None, value, declared.unit)
            low, high = sorted(factor * value / size for factor in REACH)
            step = 10.0 ** math.floor(math.log10((high - low) / 100.0))
            low, high = step * math.floor(low / step), step * math.ceil(high / step)
            name = f"{path.name.replace('contact.', '')}{f' ({unit})' if unit else ''}"
            slider = pn.widgets.EditableFloatSlider(label=name, value=value / size, start=low, end=high, step=step)
            slider.param.watch(partial(self._enter, path.name, size), "value_throttled")
            made.append(slider)
        return made

    def _enter(self, name: str, size: float, event: Any) -> None:
        setting, value = self._explorer.setting, event.new * size
        whole = name.rpartition(".")[2] in ("nodes", "frames")
        self._explorer.change(replace(setting, values={**setting.values, name: 2.0 * round(value / 2.0) if whole else value}))

    def show(self) -> None:
        """Show the answer of the explorer."""
        run: PlanarSolution = self._explorer.answer.run
        rates, times, y = np.abs(run.slip_rate).T, run.times, run.slab.y / 1e3
        largest = float(rates.max()) or 1.0
        shown = np.where(rates > 0.0, rates, np.nan).astype(np.float32)
        apart = y[1] - y[0]
        frame = {"x": [times[0]], "y": [y[0] - 0.5 * apart], "dw": [times[-1] - times[0]], "dh": [len(y) * apart]}
        self.colours.update(low=DARKEST * largest, high=largest)
        self.image.data = {"image": [shown]} | frame
        at = run.slab.nodes // 2
        self.middle.data = {"time": times, "slip": run.slip[:, at], "rate": run.slip_rate[:, at]}
        self.say()

    def say(self) -> None:
        """Show what is wrong, or what is under way, and what happened in the last run."""
        explorer = self._explorer
        notes = explorer.answer.notes if explorer.answer else ()
        lines = [f'<p class="fault">{escape(explorer.fault)}</p>' if explorer.fault else "", f"<p>{escape(explorer.progress)}</p>"]
        self.words.object = f'<div class="words">{"".join(lines)}{"".join(f"<p>{escape(one)}</p>" for one in notes)}</div>'


def build_fault(explorer: Explorer) -> Any:
    """Return the page of an explorer of a fault."""
    return FaultPage(explorer).view
