"""What the pictures of an answer show beside the motion: friction law, contact equation, the inside of a slab, and energy."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.contact import Uniqueness
from stickslip.engine import History, Positions
from stickslip.extensions.explorer.model.answer import BodyCurves, ContactPicture, CurveName, EnergyPicture, LawPicture, SlabPicture
from stickslip.extensions.explorer.model.asked import SHOWN_KINDS
from stickslip.extensions.explorer.model.sampled_waves import SampledWaves, ShownInterval
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import si_unit
from stickslip.friction import FrictionLaw, LaggedFriction
from stickslip.friction.contract import one_argument
from stickslip.problem import Problem
from stickslip.solution import Solution, Window, fronts_of
from stickslip.solution.observables import FULL, energies, heat, shaken, speed, taken

POINTS_OF_CURVE = 600
"""Number of points of the curve."""
MARGIN_OF_CURVE = 0.15
"""Margin before and after the range that the run passed through, as a share of that range."""
SCALES = 4.0
"""Number of characteristic slip rates of the law that are shown at least."""
DECADES = 20
"""Largest number of decades of slip rate that a logarithmic axis shows."""
SMALLEST_JUMP_DRAWN = 1e-3
"""Jumps that change the slip rate by a smaller share of it are not seen: pieces of the history meet within a tolerance only."""
PATH, INSIDE, CELLS = 20_000, 8, 500
"""The path has `INSIDE` points in each piece of the history, or fewer if there were more than `PATH`. Of those that lie in one of
`CELLS` times `CELLS` cells of the picture, one after the other, it keeps the first and the last."""


def law_picture(solution: Solution, motion: BodyCurves) -> LawPicture:
    """Return the friction law of a run as a curve."""
    law = solution.problem.friction
    if law.depends_on_slip and not law.depends_on_rate:
        return _along_slip(solution)
    backward = bool((solution.history.store.mode < 0).any())
    # Forward slip ends at a rate that rounding may put below zero: that is no slip backward.
    picture = _along_rate(solution.problem, motion.slip_rate if backward else np.maximum(motion.slip_rate, 0.0))
    return picture if not law.states else replace(picture, path=_law_path(solution, log=picture.log))


def _along_slip(solution: Solution) -> LawPicture:
    history, law = solution.history, solution.problem.friction
    everywhere = np.arange(len(history))
    slips = np.concatenate([history.law_slip(Positions.inside(everywhere, end)) for end in (0.0, 1.0)])
    visited = float(slips.min()), float(slips.max())
    margin = MARGIN_OF_CURVE * (visited[1] - visited[0]) or _slip_scale(law)
    low = visited[0] - margin if law.counts == "net" and law.memory == "all" else max(visited[0] - margin, 0.0)
    knots = [knot for knot in law.knots if low < knot < visited[1] + margin]
    slip = np.union1d(np.linspace(low, visited[1] + margin, POINTS_OF_CURVE), knots)
    return LawPicture("slip", slip, law.static_coefficient(slip), visited, log=False)


def _slip_scale(law: FrictionLaw) -> float:
    """Return a slip scale (m) of a law: that of its first knot, or one over its steepest relative slope at slip 0."""
    if law.knots:
        return abs(law.knots[-1]) or 1.0
    slope = abs(float(law.slopes(0.0)[0]))
    return law.variation / slope if slope > 0.0 else 1.0


def _along_rate(problem: Problem, rates: Floats) -> LawPicture:
    """Return the law along slip rate; of a run that reverses in both directions, on a linear axis: no logarithm passes zero."""
    law = problem.friction
    speeds, mirrored = np.abs(rates), bool(rates.min() < 0.0 and (rates.max() > 0.0 or not law.states))
    moving, fastest = speeds[speeds > 0.0], float(speeds.max())
    scales = [scale for scale in law.rate_scales if 0.0 < scale < np.inf]
    log = bool(law.states) and not mirrored
    if log:
        top = 10.0 * max(fastest, min(scales, default=1e-6))
        bottom = max(0.1 * min(float(moving.min()) if moving.size else top, min(scales, default=top)), top * 10.0**-DECADES)
        rate = np.geomspace(bottom, top, POINTS_OF_CURVE)
    else:
        top = max((1.0 + MARGIN_OF_CURVE) * fastest, 0.0 if law.states else SCALES * min(scales, default=0.0)) or 1.0
        knots = [knot for knot in law.knots if 0.0 < knot < top and law.knot_variable == "rate"]
        rate = np.unique(
            np.concatenate(
                [np.linspace(0.0, top, POINTS_OF_CURVE // 2), np.geomspace(1e-6 * top, top, POINTS_OF_CURVE // 2), knots]
            )
        )
    name, coefficient = _coefficient(problem, rate)
    if not mirrored:
        return LawPicture("slip_rate", rate, coefficient, (float(speeds.min()), fastest), log, name)
    beyond = 0 if coefficient[0] != 0.0 else 1  # both limits at a rate of zero, where friction jumps from one sign to the other
    rate, coefficient = (np.concatenate([-values[::-1], values[beyond:]]) for values in (rate, coefficient))
    return LawPicture("slip_rate", rate, coefficient, (float(rates.min()), float(rates.max())), log, name)


def _law_path(solution: Solution, *, log: bool) -> Floats:
    """Return slip rate and friction coefficient along a run, with NaN at jumps; for a logarithm magnitudes, with NaN at rest.

    The times are those of the pieces of its history, because an event of seconds may lie in a run of years.
    """
    breaks = solution.breaks
    inside = min(max(PATH // len(breaks), 1), INSIDE)
    right = np.append(np.linspace(breaks[:-1], breaks[1:], inside, endpoint=False).T.ravel(), breaks[-1])
    order = np.argsort(np.concatenate([breaks, right]), kind="stable")  # the limits from the left first
    rate, traction = (
        np.concatenate([curve(breaks, side="left"), curve(right)])[order] for curve in (solution.slip_rate, solution.traction)
    )
    moves = np.where(rate == 0.0, np.nan, np.sign(rate)) if log else np.ones(len(rate))
    path = np.column_stack([moves * rate, moves * traction / solution.problem.normal])
    is_left = order < len(breaks)
    jumps = np.flatnonzero(is_left[:-1] & (np.abs(np.diff(rate)) > SMALLEST_JUMP_DRAWN * np.abs(rate[1:]))) + 1
    return _thinned(np.insert(path, jumps, np.nan, axis=0), log=log)


def _thinned(path: Floats, *, log: bool) -> Floats:
    """Return a path without points that a picture would show at the place of the one before."""
    place = np.column_stack([np.log10(path[:, 0]) if log else path[:, 0], path[:, 1]])
    low, high = np.nanmin(place, axis=0, initial=np.inf), np.nanmax(place, axis=0, initial=-np.inf)
    cell = np.round(CELLS * (place - low) / np.where(high > low, high - low, 1.0))
    moved = (cell[1:] != cell[:-1]).any(axis=1)
    kept: Floats = path[np.append(True, moved) | np.append(moved, True)]
    return kept


def _coefficient(problem: Problem, rate: Floats) -> tuple[CurveName, Floats]:
    """Return the coefficient at slip rates, at the slip of the start for a law of slip, in steady sliding for one with a state."""
    law = problem.friction
    if (steady := getattr(law, "steady_coefficient", None)) is not None:
        return "steady state", steady(rate)
    if isinstance(law, LaggedFriction):
        return "steady state", law.coefficient(problem.law_slip, rate, rate)
    name: CurveName = "law" if not law.states else "law at the state of the start"
    return name, law.coefficient(problem.law_slip, rate, one_argument(problem.states))


CURVE_POINTS = 500
"""Number of evenly spaced slip rates of the curve; as many in even ratios, folds and knots are added."""
BEYOND_FASTEST = 1.15
"""The curve reaches this far beyond the fastest slip rate of the run, and of the jumps of the rule."""


def contact_picture(contact: Uniqueness, motion: BodyCurves) -> ContactPicture | None:
    """Return the contact equation and the run's path on it; None if the slip rate is a state and follows from no such equation."""
    g = contact.resistance
    if g is None:
        return None
    fastest = [float(np.abs(motion.slip_rate).max()), *(max(jump.rate_before, jump.rate_after) for jump in contact.jumps)]
    fastest += [2.0 * fold.rate for fold in contact.folds]
    top = BEYOND_FASTEST * max(fastest) or 2.0 * min(g.scales)
    own = [*(fold.rate for fold in contact.folds), *g.rate_knots]
    grid = np.concatenate([np.linspace(0.0, top, CURVE_POINTS), np.geomspace(1e-5 * top, top, CURVE_POINTS), own])
    rate = np.unique(grid[grid <= top])
    excess, slope = g.excess_and_slope(rate)
    load, kind = g.strength + excess, np.sign(slope).astype(np.int64)
    if motion.slip_rate.min() < 0.0:  # the mirror image, after a gap
        rate, load = (np.concatenate([-values[::-1], [np.nan], values]) for values in (rate, load))
        kind = np.concatenate([kind[::-1], [0], kind])
    time, path_rate, path_load = _path(motion)
    return ContactPicture(
        rate=rate,
        load=load,
        stability=kind,
        strength=g.strength,
        folds=np.array([(fold.rate, fold.load) for fold in contact.folds]).reshape(-1, 2),
        jumps=np.array([(jump.rate_before, jump.load, jump.rate_after, jump.load) for jump in contact.jumps]).reshape(-1, 4),
        path_time=time,
        path_rate=path_rate,
        path_load=path_load,
    )


def _path(motion: BodyCurves) -> tuple[Floats, Floats, Floats]:
    """Return time, slip rate and load of a run, with NaN for rate and load where the slip rate jumps."""
    jumps: NDArray[np.intp] = np.flatnonzero((np.diff(motion.time) == 0.0) & (np.diff(motion.slip_rate) != 0.0)) + 1
    return (
        np.insert(motion.time, jumps, motion.time[jumps]),
        np.insert(motion.slip_rate, jumps, np.nan),
        np.insert(motion.load, jumps, np.nan),
    )


COLUMNS, ROWS = 240, 60
"""Largest numbers of times and of places of the picture."""


def slab_picture(waves: SampledWaves) -> SlabPicture:
    """Return the picture of a slab.

    Velocity and stress are means over the time of a cell: a cell that a wave front passes lies between the values before and after,
    so that the edge follows the characteristic, and a pulse that is shorter than a cell is not passed over.
    """
    shown, thickness = waves.shown, waves.body.distance
    time, place = np.linspace(shown.start, shown.end, COLUMNS), np.linspace(0.0, thickness, ROWS)
    edges = np.concatenate([time[:1], 0.5 * (time[1:] + time[:-1]), time[-1:]])[:, None]
    velocity, stress = waves.velocity_and_stress(edges[:-1], edges[1:], place)
    displacement = waves.displacement(time[:, None], place, _slip(waves, time)[:, None])
    fronts = fronts_of(shown.readings, shown.start, shown.end)
    places = [np.where(np.arange(len(times)) % 2, thickness, 0.0) for times in fronts]
    return SlabPicture(
        time + shown.begin,
        place,
        displacement - displacement[0],
        velocity,
        stress,
        tuple(np.column_stack([times + shown.begin, x]) for times, x in zip(fronts, places, strict=True)),
    )


def _slip(waves: SampledWaves, time: ArrayLike) -> Floats:
    readings = waves.shown.readings
    return readings.event_slip(time) if isinstance(readings, Window) else readings.slip(time)


LONG_HISTORY, FEW_NODES = 1_000, 4
"""In a history with at least LONG_HISTORY pieces, energies are integrated with FEW_NODES nodes on each: with all nodes that would
take longer than the run, and a picture shows no difference.
"""
SLAB_PLACES = 240
"""Number of places in the slab for the sum over the product of its two waves."""


def energy_picture(shown: ShownInterval, waves: SampledWaves | None) -> EnergyPicture:
    """Return the parts of the energy; none where the waves in a slab are not known because the run leaped over creep."""
    body = shown.readings.problem.body
    unit = si_unit("energy", body.load_unit)
    of_kind = SHOWN_KINDS[body.structure]
    time = np.linspace(shown.start, shown.end, of_kind.times)
    found = of_kind.energies(shown, waves, time)
    if found is None:
        return EnergyPicture(time + shown.begin, {}, unit)
    elastic = found["stored"] - found["kinetic"]
    parts = {"elastic": elastic - elastic.min(), "kinetic": found["kinetic"]}
    parts |= {name: found[name] - found[name][0] for name in ("heat", "radiated", "damped")}
    drawn = {name: values for name, values in parts.items() if values.any()}
    total = parts["elastic"][0] + parts["kinetic"][0] + found["work"] - found["work"][0] + parts["radiated"]
    return EnergyPicture(time + shown.begin, drawn | {"total": total}, unit)


def exact_energies(shown: ShownInterval, time: Floats) -> dict[str, Floats]:
    """Return the energies of a body from its history."""
    history = shown.readings.history
    return energies(history, history.find(time, "right"), _nodes(history))


def _nodes(history: History) -> int:
    return FEW_NODES if len(history) > LONG_HISTORY else FULL


def energies_of_waves(waves: SampledWaves, time: Floats) -> dict[str, Floats]:
    """Return the energies of a slab: what is stored from its waves, the heat from the law, so that they need not balance."""
    at = waves.history.find(time, "right")
    contact = 0.5 * waves.body.inertia * speed(waves.history, at) ** 2
    return {
        "work": waves.work(time) + shaken(waves.history, at),
        "heat": heat(waves.history, at, _nodes(waves.history)),
        "stored": waves.stored(time) + contact,
        "kinetic": waves.kinetic(time, SLAB_PLACES) + contact,
        "radiated": waves.radiated(time),
        "damped": taken(waves.history, at, _nodes(waves.history)),
    }
