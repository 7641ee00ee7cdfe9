"""The strip on the page: 200 runs of one parameter below the panels, where a click goes to the run at that place."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import panel as pn
import param
from panel.custom import JSComponent

from stickslip.extensions.explorer.model.controls import controls_of
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.strip import (
    SHOWN,
    Strip,
    choices,
    numeric,
    present,
    setting_at,
    strip_of,
    strip_range,
    strip_text,
    usual_range,
)
from stickslip.extensions.explorer.page.components import Markup, asset, finite, paint
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.stage import Stage
from stickslip.extensions.explorer.page.view import LegendKey, View, axis_label, heading, limits
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import for_readers, readable_unit
from stickslip.foundation.quantities import Quantity
from stickslip.problem.scenarios import ParameterPath, typed_number

NAMES = {"pulses": "Pulses", "slip": "Slip", "first_end": "First arrest", "peak_rate": "Peak slip rate"}
LARGEST_POWER = 300.0
"""Look for powers of ten on a logarithmic axis up to this one."""
HEIGHT = 124
"""Height (px) of the plots with their headings."""
COLOURS = {"pulses": "ink", "slip": "slip", "first_end": "traction", "peak_rate": "rate"}
TICK = "return facts.data.log[0] ? String(Number((10 ** tick).toPrecision(3))) : String(Number(tick.toPrecision(6)))"
"""Text of a tick of the parameter's axis, which is linear in the power of ten for a logarithmic strip."""


def plots(stage: Stage) -> dict[str, Any]:
    """Return the plots of a strip by quantity, without data."""
    return {name: _plot(stage, name) for name in SHOWN}


def _plot(stage: Stage, name: str) -> Any:
    from bokeh.models import CustomJSTickFormatter, Span

    drawn = stage.plot(f"strip_{name}", "strip_x", f"strip_{name}_y", f"Strip: {NAMES[name]} of 200 runs against a parameter")
    drawn.xaxis[0].ticker.desired_num_ticks = drawn.yaxis[0].ticker.desired_num_ticks = 3
    bands = stage.source("strip_bands", "x0", "x1")
    paint(drawn.vstrip(x0="x0", x1="x1", source=bands, line_width=0, fill_alpha=0.1).glyph, fill_color="unstable")
    facts = stage.source("strip_facts", "log")
    drawn.xaxis.formatter = CustomJSTickFormatter(args={"facts": facts}, code=TICK)
    source = stage.source("strip", "x", *SHOWN)
    paint(drawn.scatter("x", name, source=source, size=3.5, line_width=0).glyph, fill_color=COLOURS[name])
    line = Span(location=0.0, dimension="height", level="overlay", line_width=1.2)
    drawn.add_layout(paint(stage.note(f"here:strip_{name}", line), line_color="cursor"))
    return drawn


def view_of_strip(strip: Strip, shown_in: tuple[str, float] | None = None) -> View:
    """Return what the plots show of a strip; its parameter is shown in a unit (name, size in SI), by default a readable one."""
    unit, size = shown_in or readable_unit(strip.unit, strip.values, log=strip.log)
    x = place_of(strip, strip.values, size)
    view = View(columns={"strip": {"x": x}, "strip_facts": {"log": [strip.log]}}, limits={"strip_x": (float(x[0]), float(x[-1]))})
    for name in SHOWN:
        shown, scale = readable_unit(strip.units[name], strip.results[name])
        values = view.columns["strip"][name] = strip.results[name] / scale
        view.limits[f"strip_{name}_y"] = limits(values, 0.0, floor=0.0)
        view.titles[f"strip_{name}"] = axis_label(NAMES[name], "", for_readers(shown))
    view.keys[f"strip_{SHOWN[0]}"] = (LegendKey("irregular", "unstable", "area"),) if strip.results["irregular"].any() else ()
    view.labels = {f"axis:strip_x@strip_{name}": axis_label(strip.parameter, "", unit) for name in SHOWN}
    view.columns["strip_bands"] = dict(zip(("x0", "x1"), _bands(x, strip.results["irregular"]), strict=True))
    view.facts["strip"] = {"size": size, "log": strip.log}
    return view


def place_of(strip: Strip, values: Any, size: float) -> Any:
    """Return where values (SI) of the parameter lie on the axis of a strip."""
    shown = np.asarray(values, float) / size
    return np.log10(np.maximum(shown, 1e-300)) if strip.log else shown


def _bands(x: Any, irregular: Any) -> tuple[list[float], list[float]]:
    """Return the ends of the intervals with an irregular contact."""
    inside = np.concatenate([[False], irregular == 1.0, [False]])
    edges = np.flatnonzero(inside[1:] != inside[:-1])
    middles = np.concatenate([x[:1], (x[1:] + x[:-1]) / 2, x[-1:]])
    return middles[edges[::2]].tolist(), middles[edges[1::2]].tolist()


class StripBar(JSComponent):  # type: ignore[misc] # panel has no types
    """The bar above the plots: parameter and range."""

    state = param.Dict(default={"choices": []}, doc="Choices of parameters, the chosen range, and what is said of the strip.")

    _esm = asset("strip.js")

    def __init__(self, chosen: Callable[[dict[str, Any]], None], **params: Any) -> None:
        self._chosen = chosen
        super().__init__(stylesheets=[asset("strip.css")], **params)

    def _handle_msg(self, data: Any) -> None:
        if isinstance(data, dict) and isinstance(data.get("parameter"), str):
            self._chosen(data)


class StripView:
    """The strip of one page. `view` is placed below the panels."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer, self._stage = explorer, Stage()
        self.strip: Strip | None = None
        self._made_of: tuple[Axis, Any] | None = None
        self._unit = ("", 1.0)
        self.bar = StripBar(self._choose, sizing_mode="stretch_width", margin=0)
        found = plots(self._stage)
        for plot in found.values():
            plot.on_event("tap", self._tapped)
        css = [asset("heading.css")]
        self._headings = {name: Markup(sizing_mode="stretch_width", margin=0, stylesheets=css) for name in found}
        panes = [
            pn.Column(self._headings[name], pn.pane.Bokeh(plot, sizing_mode="stretch_both", margin=0), margin=0, height=HEIGHT)
            for name, plot in found.items()
        ]
        self.plots = pn.GridBox(
            *panes, ncols=len(panes), sizing_mode="stretch_width", margin=0, visible=False, stylesheets=[asset("strip_plots.css")]
        )
        self.view = pn.Column(self.bar, self.plots, sizing_mode="stretch_width", margin=0)
        explorer.listen("answer", self._ask)
        explorer.listen("strip", self._ask)
        self._tell()

    def _choose(self, data: dict[str, Any]) -> None:
        """Take what was entered in the bar, which may be anything."""
        explorer, name = self._explorer, str(data["parameter"])
        try:
            if not name:
                explorer.show_strip(None)
            elif "low" not in data:
                explorer.show_strip(usual_range(explorer.setting.scenario(), name))
            else:
                explorer.show_strip(self._entered(name, data))
        except InputError as error:
            self._tell(str(error))

    def _entered(self, name: str, data: dict[str, Any]) -> Axis:
        found = numeric(self._explorer.setting.scenario(), name)
        size = self._unit_of(usual_range(self._explorer.setting.scenario(), name))[1]
        low, high = (_read(str(data.get(end))[:100], found, size) for end in ("low", "high"))
        return strip_range(found.name, low, high, log=data.get("log") is True)

    def _ask(self) -> None:
        """Have the strip worked out, unless it is the one that is shown: then only its mark moves."""
        explorer, where = self._explorer, self._explorer.strip
        if where is None or explorer.answer is None:
            self.strip = self._made_of = None
            self.plots.visible = False
            self._tell()
            return
        try:
            made_of = (where, setting_at(explorer.setting, where.parameter, where.high).document)
        except InputError:  # another body or law, which has no such parameter
            explorer.show_strip(None)
            return
        if made_of == self._made_of:
            self._mark()
            return
        scenario = explorer.answer.scenario
        explorer.beside(lambda told: strip_of(scenario, where, told), lambda strip: self._show(strip, made_of))

    def _show(self, strip: Strip, made_of: tuple[Axis, Any]) -> None:
        self.strip, self._made_of = strip, made_of
        with pn.io.hold():
            self._unit = unit_shown(self._explorer.setting, made_of[0])
            view = view_of_strip(strip, self._unit)
            self._stage.show(view)
            for name, pane in self._headings.items():
                pane.object = heading(view.titles[f"strip_{name}"], view.keys.get(f"strip_{name}", ()))
            self._mark()
            self.plots.visible = True
            self._tell(strip_text(strip))
        self._explorer.told("")

    def _mark(self) -> None:
        assert self.strip is not None
        scenario = self._explorer.setting.scenario()
        here = float(place_of(self.strip, present(scenario, numeric(scenario, self.strip.parameter)), self._unit[1]))
        for name in SHOWN:
            self._stage.named[f"here:strip_{name}"].location = here

    def _tapped(self, event: Any) -> None:
        x = finite(event.x)
        if self.strip is None or x is None:
            return
        value = (10.0 ** min(max(x, -LARGEST_POWER), LARGEST_POWER) if self.strip.log else x) * self._unit[1]
        explorer = self._explorer
        nearest = float(self.strip.values[self.strip.nearest(value)])
        explorer.change(setting_at(explorer.setting, self.strip.parameter, nearest))

    def _unit_of(self, where: Axis) -> tuple[str, float]:
        """Return the unit of a range: that of the strip that is shown, if it is one of the same parameter."""
        is_shown = self.strip is not None and self.strip.parameter == where.parameter
        return self._unit if is_shown else unit_shown(self._explorer.setting, where)

    def _tell(self, said: str = "") -> None:
        """Show in the bar what may be chosen, what is, and a line on it."""
        scenario, where = self._explorer.setting.scenario(), self._explorer.strip
        chosen = None
        if where is not None:
            unit, size = self._unit_of(where)
            ends = {"low": f"{where.low / size:.6g}", "high": f"{where.high / size:.6g}"}
            chosen = {"parameter": where.parameter, **ends, "log": where.log, "unit": unit}
        self.bar.state = {"choices": choices(scenario), "chosen": chosen, "said": said}


def unit_shown(setting: Setting, where: Axis) -> tuple[str, float]:
    """Return the unit (name, size in SI) of a parameter in the controls, or a readable one if it has no control.

    It is that of a pure number if the scenario has no such parameter, as before the first answer of a link.
    """
    controls = (control for group in controls_of(setting) for control in group.controls)
    found = next((control for control in controls if control.path == where.parameter), None)
    if found is not None:
        return for_readers(found.unit), found.size
    try:
        unit, size = readable_unit(numeric(setting.scenario(), where.parameter).unit, [where.low, where.high], log=where.log)
    except InputError:
        return "", 1.0
    return "" if unit == "1" else unit, size


def _read(typed: str, parameter: ParameterPath, size: float) -> float:
    """Return in SI what was typed: a text with a unit, or a number in a unit of the given size. Raises InputError."""
    given = typed_number(typed)
    value = float(f"{given * size:.12g}") if isinstance(given, float) else given
    assert isinstance(parameter.declared, Quantity)
    return parameter.declared.check("strip", parameter.name, value)
