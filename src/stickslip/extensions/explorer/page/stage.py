"""The Bokeh models that an answer fills: sources of data, ranges and axes, each with its name in a view."""

from __future__ import annotations

from typing import Any

from bokeh.models import ColumnDataSource, CustomJSTickFormatter, LinearAxis, LinearColorMapper, Range1d, Span
from bokeh.plotting import figure

from stickslip.extensions.explorer.page.components import FONT, paint, palettes
from stickslip.extensions.explorer.page.view import View

LEFT, NARROW, RIGHT = 62, 46, 14
"""Room (px) beside the frame of a plot, with and without a text along the vertical axis: frames that share an axis are aligned."""

POWER = """
const raised = "⁰¹²³⁴⁵⁶⁷⁸⁹"
return "10" + [...String(Math.round(tick))].map((one) => (one === "-" ? "⁻" : raised[Number(one)])).join("")
"""
"""Text of a tick of a logarithmic axis: the axis itself is linear in the power of ten, so that it can change from run to run."""


class Stage:
    """All models of one page by name, and how a view is brought to them."""

    def __init__(self) -> None:
        self.sources: dict[str, Any] = {}
        self.ranges: dict[str, Any] = {}
        self.named: dict[str, Any] = {}
        self.plots: dict[str, Any] = {}
        self.signed = signed_scale("colour")

    def source(self, name: str, *columns: str) -> Any:
        """Return the source of this name; it is made, with empty columns, when it is first asked for."""
        found = self.sources.get(name)
        if found is None:
            found = self.sources[name] = ColumnDataSource({column: [] for column in columns}, name=f"source:{name}")
        return found

    def range(self, name: str) -> Any:
        """Return the range of this name; it is made when it is first asked for."""
        found = self.ranges.get(name)
        if found is None:
            found = self.ranges[name] = Range1d(0.0, 1.0, name=f"range:{name}")
        return found

    def note(self, name: str, model: Any) -> Any:
        """Give a model a name, so that a view can hide it or change its text; return the model."""
        model.name = name
        self.named[name] = model
        return model

    def plot(self, name: str, x: str, y: str, text: str, *, left: int = LEFT, bare: bool = False) -> Any:
        """Return a plot with two named axes, in the look of the page.

        `text` describes it to readers that do not see it, `left` is the room (px) left of the frame. `bare` leaves away the texts
        of the horizontal axis, which a plot below shows too.
        """
        drawn = figure(
            x_range=self.range(x), y_range=self.range(y), sizing_mode="stretch_both", min_height=30, min_width=120,
            tools="", toolbar_location=None, output_backend="canvas", name=f"plot:{name}", lod_threshold=None,
        )  # fmt: skip
        drawn.min_border_top = 6
        # The card below shows through: Bokeh clears the edge of a canvas by half only, so that the colour of another ground stays.
        drawn.border_fill_color = drawn.background_fill_color = drawn.outline_line_color = None
        paint(drawn, sizes={"min_border_left": left, "min_border_right": RIGHT})
        drawn.xaxis.name, drawn.yaxis.name = f"axis:{x}@{name}", f"axis:{y}@{name}"
        dress(drawn.xaxis[0], 0 if bare else 11)
        dress(drawn.yaxis[0])
        drawn.yaxis[0].ticker.desired_num_ticks = 2 if left == NARROW else 5
        for grid in drawn.grid:
            paint(grid, grid_line_color="grid")
        if bare:
            drawn.xaxis.major_label_standoff = drawn.xaxis.major_tick_out = 0
            drawn.min_border_bottom = 8
        self.named[f"axis:{x}@{name}"], self.named[f"axis:{y}@{name}"] = drawn.xaxis[0], drawn.yaxis[0]
        drawn.tags = [*drawn.tags, {"text": text}]
        self.plots[name] = drawn
        return drawn

    def powers(self, drawn: Any, name: str, side: str) -> None:
        """Add an axis of powers of ten to a plot, hidden at first, for values that the plot shows as logarithms."""
        axis = LinearAxis(formatter=CustomJSTickFormatter(code=POWER), visible=False)
        axis.ticker.min_interval = 1.0
        dress(axis)
        axis.ticker.desired_num_ticks = 3 if side == "left" else 5
        drawn.add_layout(self.note(f"axis:{name}", axis), side)

    def cursor(self, name: str, dimension: str = "height") -> None:
        """Add to a plot the line of the cursor. It is drawn above all else, so that moving it repaints nothing else."""
        line = Span(location=0.0, dimension=dimension, level="overlay", line_width=1.2, name=f"cursor:{name}")
        self.plots[name].add_layout(paint(line, line_color="cursor"))

    def show(self, view: View) -> None:
        """Bring a view to the models, in place. Only what differs is sent."""
        for name, columns in view.columns.items():
            self.source(name).data = columns
        self.signed.update(low=-(view.fastest or 1.0), high=view.fastest or 1.0)
        for name, (low, high) in view.limits.items():
            self.range(name).update(start=low, end=high, reset_start=low, reset_end=high)
        for name, text in view.labels.items():
            self.named[name].axis_label = text
        for name, model in self.named.items():
            model.visible = name not in view.hidden


def signed_scale(name: str) -> Any:
    """Return a colour scale of signed values, with a name that lets the browser set its ends."""
    return LinearColorMapper(palette=palettes()["light"]["signed"], low=-1.0, high=1.0, name=name, tags=[{"palette": "signed"}])


def dress(axis: Any, size: float = 11) -> None:
    """Give an axis the look of the page; `size` (px) is that of the texts of its ticks."""
    axis.minor_tick_line_color = None
    axis.major_tick_in, axis.major_tick_out = 0, 4
    axis.axis_label_text_font_style, axis.axis_label_text_font, axis.major_label_text_font = "normal", FONT, FONT
    axis.axis_label_standoff = 5
    axis.ticker.desired_num_ticks = 5
    paint(
        axis, axis_line_color="faint", major_tick_line_color="faint", axis_label_text_color="ink", major_label_text_color="muted",
        sizes={"axis_label_text_font_size": 12, "major_label_text_font_size": size},
    )  # fmt: skip
