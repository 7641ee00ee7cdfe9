"""The panels of a fault in 2D: what slips where and when, profiles along the contact at the cursor, and the node in the middle."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.explorer.model.fault import FaultAnswer
from stickslip.extensions.explorer.page.components import paint
from stickslip.extensions.explorer.page.panels import energy, field, motion
from stickslip.extensions.explorer.page.stage import NARROW, Stage
from stickslip.extensions.explorer.page.view import LegendKey, Units, View, axis_label, limits, single
from stickslip.figures.style import nearly_flat
from stickslip.foundation.given import PLACE
from stickslip.foundation.names import name_of, readable_unit

TITLES_OF_FAULT = {
    "profile_rate": "Slip rate along the contact now", "profile_slip": "Slip along the contact now", "slip": "Slip",
    "rate": "Slip rate", "traction": "Traction", "field": "Contact in space and time", "energy": "Energy",
}  # fmt: skip
"""Titles of the panels before the first answer."""
TEXTS_OF_FAULT = {
    "profile_rate": "Slip rate against place along the contact, at the time of the cursor",
    "profile_slip": "Slip against place along the contact, at the time of the cursor",
}
MAP = "Slip rate, slip or change of traction along the contact against time"
MOST_COLUMNS = 400
"""Largest number of moments of the map, which are evenly spaced; each shows the frame that is nearest to it."""


def view_of_fault(answer: FaultAnswer, kept: FaultAnswer | None = None) -> View:
    """Return all that the panels show of a fault, with the run that is kept beside it."""
    units = _units(answer, kept)
    view = _motion(answer, kept, units)
    view.add(_map(answer, units))
    if answer.energy is None:
        span = view.limits["time"]
        near = {"size": units.near[1], "begin": 0.0, "whole": True, "from": span[0], "to": span[1]}
        view.add(View(limits={"near": span}, hidden={"energy"}, facts={"near": near}))
    else:
        view.add(energy.data_of(answer, units))  # type: ignore[arg-type] # what it reads of an answer is there
        view.titles["energy"] = view.titles["energy"].replace("Energy", "Energy per metre of z")
    view.facts["hidden"] = sorted(view.hidden)
    return view


def _units(answer: FaultAnswer, kept: FaultAnswer | None) -> Units:
    main, run = answer.motions[0], answer.run
    both = (main, *(kept.motions if kept else ()))
    offset = float(main.traction[0]) if nearly_flat(main.traction, main.load) else 0.0
    time, place = readable_unit("s", np.ptp(main.time)), readable_unit("m", run.slab.y, of=PLACE)
    stress = readable_unit("Pa", *(curve - offset for one in both for curve in (one.traction, one.load)))
    slip, rate = readable_unit("m", run.slip), readable_unit("m/s", run.slip_rate)
    return Units(time, time, 0.0, True, slip, rate, False, stress, offset, stress, rate, place)


def _motion(answer: FaultAnswer, kept: FaultAnswer | None, units: Units) -> View:
    """Return the motion of the node in the middle, and that of the kept run."""
    curves = motion.columns_of(answer.motions[0], units)
    beside = {name: [] for name in motion.COLUMNS_OF_MOTION} if kept is None else motion.columns_of(kept.motions[0], units)
    nothing: dict[str, Any] = {name: [] for name in motion.COLUMNS_OF_MOTION}
    further = () if kept is None else (LegendKey("pinned", "pin"),)
    names = {"slip": ("slip",), "rate": ("rate_at",), "traction": ("traction", "load")}
    marks = [{"time": one.time / units.time[1], "kind": one.kind, "text": one.text} for one in answer.marks]
    clock = (float(curves["time"][0]), float(curves["time"][-1]))
    return View(
        columns={
            "motion": curves, "companion": nothing, "measured": nothing, "pinned": beside,
            "marks": {"time": [mark["time"] for mark in marks]},
        },
        limits={"time": clock}
        | {name: limits(*(one[column] for one in (curves, beside) for column in columns)) for name, columns in names.items()},
        labels={"axis:time@traction": axis_label("time", "t", units.time[0])},
        titles=motion.titles({panel: f"{name_of(curve)} in the middle" for panel, curve in motion.CURVE_OF.items()}, units),
        keys={
            "slip": further,
            "rate": further,
            "traction": (LegendKey("traction", "traction"), LegendKey("load", "load", "dot"), *further),
        },
        hidden={"axis:rate_powers"},
        facts={
            "time": {"unit": units.time[0], "size": units.time[1], "from": clock[0], "to": clock[1]},
            "read": motion.read(units),
            "marks": marks,
        },
    )  # fmt: skip


def _map(answer: FaultAnswer, units: Units) -> View:
    """Return slip rate, slip and change of traction as images: rows are places, columns are times."""
    run = answer.run
    time, frames = _even(run.times)
    y, width = run.slab.y / units.place[1], run.slab.spacing[0] / units.place[1]
    step = float(time[1] - time[0]) / units.time[1]
    shape = {"x": [float(time[0]) / units.time[1] - 0.5 * step], "y": [float(y[0]) - 0.5 * width]}
    shape |= {"dw": [step * time.size], "dh": [width * y.size]}
    change = (run.traction - run.traction[0])[frames].T
    pascal = readable_unit("Pa", change)
    images = {
        "velocity": single(run.slip_rate[frames].T / units.rate[1]),
        "displacement": single(run.slip[frames].T / units.slip[1]),
        "stress": single(change / pascal[1]),
    }
    names = {"velocity": units.rate[0], "displacement": units.slip[0], "stress": pascal[0]}
    fields = {name: field.ends_of(images[name], unit) for name, unit in names.items()}
    ends = (float(y[0]) - 0.5 * width, float(y[-1]) + 0.5 * width)
    return View(
        columns={
            "field": {name: [one] for name, one in images.items()} | shape,
            "fronts": {"time": [], "place": []},
            "profile": {"y": y, "rate": images["velocity"][:, 0], "slip": images["displacement"][:, 0]},
        },
        limits={
            "place": ends, "along": ends,
            "profile_rate": limits(images["velocity"]), "profile_slip": limits(images["displacement"]),
        },
        labels={f"axis:along@{name}": axis_label("along the contact", "y", units.place[0]) for name in TEXTS_OF_FAULT},
        fastest=fields["velocity"]["most"],
        titles={
            "field": axis_label("Along the contact:", "y", units.place[0]),
            "profile_rate": axis_label("Slip rate along the contact now", "v", units.rate[0]),
            "profile_slip": axis_label("Slip along the contact now", "u", units.slip[0]),
        },
        keys={"field": (LegendKey(f"slip rate {fields['velocity']['text']}", "signed", "scale"),)},
        facts={"fields": fields, "profile": True},
    )  # fmt: skip


def _even(times: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Return evenly spaced times (s), and for each the frame that is nearest to it."""
    if len(times) < 2:
        return np.array([times[0], times[0] + 1e-9]), np.zeros(2, int)
    even = np.linspace(times[0], times[-1], min(len(times), MOST_COLUMNS))
    return even, np.abs(times[:, None] - even).argmin(axis=0)


def plots(stage: Stage) -> dict[str, Any]:
    """Return all plots of a fault by name, without data."""
    profiles = {}
    for name in TEXTS_OF_FAULT:
        drawn = profiles[name] = stage.plot(name, "along", name, TEXTS_OF_FAULT[name], left=NARROW)
        column = name.removeprefix("profile_")
        paint(drawn.line("y", column, source=stage.source("profile", "y", "rate", "slip"), line_width=2).glyph, line_color=column)
    return profiles | motion.plots(stage) | {"field": field.plot(stage, MAP), "energy": energy.plot(stage)}
