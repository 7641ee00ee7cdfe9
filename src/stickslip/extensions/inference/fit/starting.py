"""Starting values of free numbers from the record itself: levels and slopes of stick-slip, plateaus of velocity steps."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from stickslip.extensions.inference.fit.asked import FITTED_KINDS
from stickslip.extensions.inference.fit.by_features import events_of
from stickslip.extensions.inference.fit.free import DRIFT, TREND, Free
from stickslip.extensions.inference.fit.part import Part, StickSlip, changed
from stickslip.extensions.inference.fit.plateaus import PlateauDrift, drift_of, plateaus_of, transients_of
from stickslip.extensions.inference.record.features import LEVELS_OF_SHEAR, arrests_in
from stickslip.extensions.inference.record.noise import noise_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.show import brief
from stickslip.problem import LoadingHistory, Problem

FALLS_IN_EVENTS = 0.2
"""Shear falls in slip events if it falls during less than this share of the time."""


def with_starts(
    free: Sequence[Free],
    problem: Problem,
    parts: Sequence[Part],
    given: Iterable[str],
    drift: PlateauDrift | None = None,
    *,
    untold: str = "",
) -> tuple[tuple[Free, ...], list[str]]:
    """Return the free numbers with starting values from the record, and sentences on that.

    `given` has the names of those whose start the user chose. A number keeps the value of the problem as a second start. `drift` is
    that of the plateaus, if one of the numbers is. The sentences leave `untold` out, a number that may be held
    again.
    """
    given = {full_name(str(name), [one.name for one in free], "", "") for name in given}
    shown = {name: value for part in reversed(parts) for name, value in _shown(problem, part, drift, {one.name for one in free})}
    shown |= {} if drift is None else {TREND if drift.with_slip else DRIFT: drift.value}
    wanted = [one for one in free if one.name in shown and one.name not in given and one.low < shown[one.name] < one.high]
    values = {one.name: shown[one.name] for one in wanted}
    if not _allowed(problem, values):
        values = {name: value for name, value in values.items() if _allowed(problem, {name: value})}
        values = values if _allowed(problem, values) else {}
    found = [one.begun_at(values[one.name]) if one.name in values else one for one in free]
    told = [one for one in wanted if one.name in values and one.name != untold]
    texts = [f"{one.name} {brief(values[one.name], one.declared.unit, 3)}" for one in told]
    notes = [f"the search begins with what the record shows: {', '.join(texts)}; also with the values given"] if texts else []
    of_kind = FITTED_KINDS[problem.body.structure]
    doubts = dict.fromkeys(note for part in parts for note in of_kind.doubts_of_stiffness(problem, part, free))
    return tuple(found), [*notes, *doubts]


def _allowed(problem: Problem, values: Mapping[str, float]) -> bool:
    try:
        changed(problem, values)
    except InputError:
        return False
    return True


def _shown(problem: Problem, part: Part, drift: PlateauDrift | None, names: set[str]) -> Iterator[tuple[str, float]]:
    """Yield names and values (SI) of the numbers that a part of a record shows."""
    if part.record.shear_of_events is not None:
        if (cycles := stick_slip(problem, part)) is not None:
            yield from _of_law(problem, cycles, names)
            yield from FITTED_KINDS[problem.body.structure].shown(problem, part, cycles, names)
        return
    if part.record.shear is None:
        return
    friction, stepped = friction_of(problem, part), _is_stepped(problem, part)
    cycles = None if stepped else stick_slip(problem, part)  # friction falls after a step of rate, too
    if cycles is not None:
        yield from _of_law(problem, cycles, names)
        yield from FITTED_KINDS[problem.body.structure].shown(problem, part, cycles, names)
    elif not stepped and len(arrests_in(friction)):
        yield "friction.static", float(np.nanmax(np.abs(friction)))
    else:
        yield from _of_steps(problem, part, drift, names)


def _is_stepped(problem: Problem, part: Part) -> bool:
    """Return True if friction may fall after a step of the pull rate, so that not every fall is a slip event."""
    pull = problem.pull_rate if part.loading is None else part.loading
    return isinstance(pull, LoadingHistory) and hasattr(problem.friction, "distance") and bool(problem.friction.states)


def slides(problem: Problem, part: Part) -> bool:
    """Return True if the contact of a part of a record slides all the time, as far as shear shows: without slip events."""
    if part.record.shear is None or part.record.shear not in part.observed:
        return False
    return _is_stepped(problem, part) or not has_events(friction_of(problem, part))


def has_events(friction: Floats) -> bool:
    """Return True if shear falls as in slip events, much faster than it rises, and not as where it drifts."""
    known = friction[np.isfinite(friction)]
    bottoms = [0, *arrests_in(known).tolist()]
    falling = sum(last - first - int(np.argmax(np.abs(known[first : last + 1]))) for first, last in pairwise(bottoms))
    return bool(0 < falling < FALLS_IN_EVENTS * bottoms[-1])


def shown_drift(problem: Problem, parts: Sequence[Part], *, with_slip: bool | None = None) -> PlateauDrift | None:
    """Return the drift of the plateaus of a record, seen or not; None if there is none to look at, as in stick-slip.

    It is one with slip or with time if that is asked for, and else what the plateaus look like.
    """
    sliding = [part for part in parts if slides(problem, part)]
    return drift_of([plateaus_of(problem, part, friction_of(problem, part)) for part in sliding], with_slip)


def friction_of(problem: Problem, part: Part) -> Floats:
    """Return the measured friction of a part."""
    name = part.record.shear
    assert name is not None
    return part.record.measured[name] / (1.0 if name == "friction" else problem.normal)


def stick_slip(problem: Problem, part: Part) -> StickSlip | None:
    """Return the typical levels, slope and duration of a part's slip events; None for fewer than two after the first one."""
    try:
        events, _ = events_of(part)
    except InputError:
        return None
    levels = [f"{events.shear_of_events}_{level}" for level in LEVELS_OF_SHEAR]
    if len(events) < 2 or not set(levels) <= set(events.measured):
        return None
    (peak, rest, drop), scale = (
        (events.measured[name] for name in levels),
        1.0 if events.shear_of_events == "friction" else problem.normal,
    )
    clock = events.time - part.record.time[0]
    loading = problem.pull_rate if part.loading is None else part.loading
    if isinstance(loading, LoadingHistory):
        loading = float(np.mean(loading.at(np.linspace(clock[0], clock[-1], 1000))))
    pull = abs(loading)
    moved = pull * float(np.nanmean(events.measured["recurrence"]))
    rise = float(np.nanmean(drop)) / scale * problem.normal / moved if moved > 0.0 else math.nan
    lasting = events.measured.get("duration", np.array([math.nan]))
    return StickSlip(float(np.nanmedian(peak)) / scale, float(np.nanmedian(rest)) / scale, rise, float(np.median(lasting)))


def _of_law(problem: Problem, cycles: StickSlip, names: set[str]) -> Iterator[tuple[str, float]]:
    """Yield static and dynamic friction: slip overshoots, so that friction in slip lies between its peak and the rest."""
    law = problem.friction
    if hasattr(law, "static") and hasattr(law, "dynamic"):
        swing = FITTED_KINDS[problem.body.structure].swing(problem.body, cycles, names)
        yield "friction.static", cycles.peak
        yield "friction.dynamic", (cycles.rest + swing * cycles.peak) / (1.0 + swing)
    elif hasattr(law, "reference"):
        yield "friction.reference", 0.5 * (cycles.peak + cycles.rest)


def _of_steps(problem: Problem, part: Part, drift: PlateauDrift | None, names: set[str]) -> Iterator[tuple[str, float]]:
    """Yield reference friction, a, b and slip distance of a rate-and-state law from steady sliding at several rates."""
    law: Any = problem.friction
    friction = friction_of(problem, part)
    plateaus = [one.without(drift) for one in plateaus_of(problem, part, friction)]
    if not plateaus or not all(hasattr(law, name) for name in ("reference", "a", "b", "distance", "rate")):
        return
    logs, levels = np.log([one.rate / law.rate for one in plateaus]), np.array([one.friction for one in plateaus])
    slope = law.a - law.b
    if float(np.ptp(logs)) > 0.1:
        slope = float(np.polyfit(logs, levels, 1)[0])
        direct, distance = transients_of(plateaus, noise_of(friction))
        a = direct if "friction.a" in names and math.isfinite(direct) else law.a
        if "friction.b" in names and a - slope > 0.0:
            yield "friction.b", a - slope
        elif "friction.a" in names and law.b + slope > 0.0:
            a = law.b + slope
        if "friction.a" in names:
            yield "friction.a", a
        if math.isfinite(distance):
            yield "friction.distance", distance
    yield "friction.reference", float(np.mean(levels - slope * logs))
