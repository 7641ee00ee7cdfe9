"""Figure of friction along a given motion: the slip rate, the states, and the traction with what is possible at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Unpack

from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, letter_panels, panels, set_title
from stickslip.figures.style import BLUE, SKY, VERMILLION, Numbers, axis_text, label, shown, styled, time_unit
from stickslip.foundation.names import name_of
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.along import FrictionAlongMotion

SYMBOLS = {"slip_rate": "v", "traction": r"\tau"}


@styled
def draw_along(run: FrictionAlongMotion, **place: Unpack[Place]) -> Figure:
    """Draw slip rate, states and traction against time, a panel for each."""
    table, unit = run.at(run.times), run.moved.load_unit
    states = [name for name in ("state", "second_state") if name in table]
    named = {name: Numbers(table[name].to_numpy(), {"units": run.units[name], "long_name": name}) for name in table.columns}
    named["slip_rate"].attrs.update(long_name=name_of("slip_rate", unit), symbol=SYMBOLS["slip_rate"])
    named["traction"].attrs.update(long_name=name_of("traction", unit), symbol=SYMBOLS["traction"])
    for name, one in zip(states, run.moved.friction.states, strict=True):
        named[name].attrs.update(long_name=one.meaning.partition(" (")[0], symbol="")
    figure, axes = panels(2 + len(states), 1, (6.5, 1.4 + 1.6 * (2 + len(states))), place, sharex=True)
    clock, second = time_unit(run.duration)
    for panel, name in zip(axes.flat, ("slip_rate", *states, "traction"), strict=True):
        panel.plot(table.time / second, shown(named[name]), color=VERMILLION if name == "slip_rate" else BLUE)
        panel.set_ylabel(label(named[name]))
    last = axes.flat[-1]
    if table.traction.isna().any():
        size = named["traction"].attrs["units"]
        bounds = [Numbers(table[f"{end}_traction"].to_numpy(), {"units": size}) for end in ("lowest", "highest")]
        low, high = (shown(one) for one in bounds)
        last.fill_between(
            table.time / second, low, high, where=table.traction.isna(), color=SKY, alpha=0.35, label="possible at rest"
        )
        add_legend(last, last.get_legend_handles_labels()[0])
    last.set_xlabel(axis_text("time", "t", clock))
    letter_panels(axes.flat)
    set_title(figure, run.title)
    return figure
