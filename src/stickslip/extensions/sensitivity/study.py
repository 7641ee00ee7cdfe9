"""Derivatives of any output of a run with respect to the numbers of its problem: `ss.studies.sensitivity`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from stickslip.engine import SlipEvents
from stickslip.extensions.sensitivity.differences import Differences, member_run
from stickslip.extensions.sensitivity.outputs import (
    EVENT_NUMBERS,
    WITHOUT_SLOPE,
    CurveAtTimes,
    NumberOfEvent,
    Output,
    curves_of,
)
from stickslip.extensions.sensitivity.result import Sensitivity
from stickslip.foundation.arguments import for_users, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Quantity
from stickslip.foundation.show import brief
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import Parameter, Problem, default_event_rate
from stickslip.problem.scenarios import Scenario, read_source
from stickslip.run import TextProgress, telling
from stickslip.solution import Solution, times_of

MEMBER_RTOL = Quantity("1", "relative tolerance of the runs", at_least=1e-15, at_most=1e-8)
TIME_ASKED = Quantity("s", "time of a curve or an energy")
FINE_RTOL = 1e-14
"""Default tolerance of the runs (1)."""
EVEN_TIMES = 360
"""Number of evenly spaced times by default."""

Source = Problem | Scenario | Solution | str | Path


@for_users
def sensitivity(
    problem: Source,
    to: str | Sequence[str] | None = None,
    of: str = "slip",
    *,
    at: ArrayLike | None = None,
    event: int | None = None,
    duration: float | str | WithUnit | None = None,
    rtol: float = FINE_RTOL,
    progress: TextProgress | bool | None = None,
) -> Sensitivity:
    """Return the derivatives of an output of a run with respect to numbers of its problem, each with an estimate of its error.

    Parameters
    ----------
    problem : Problem, Scenario, Solution, str or Path
        The problem (with a `duration`), its scenario, a run of it, the name of a bundled scenario, or a scenario file.
    to : str or sequence of str, optional
        The numbers, by their names in a scenario file or the ends of these: "friction.a", "stiffness", ["a", "b"]. By default all
        that the problem gives and that are not 0.
    of : str
        The output: a curve of the run ("slip", "slip_rate", "traction", "load", "state", "second_state", "drive_rate",
        "drive_traction", "surface_torque"), an energy ("work", "heat", ...), or a column of its slip events ("start", "end",
        "duration", "recurrence", "peak_rate", "traction_drop", ...).
    at : float, str or sequence, optional
        Times (s, or texts with a unit) of a curve or an energy. By default many, up to the end of the run.
    event : int, optional
        The row of the slip event in `solution.events`; negative ones count from the last. With it "slip" is the slip of the event.
        By default the first event that has the number.
    duration : float or str, optional
        Duration of the run (s), if the problem has none or another one is wanted.
    rtol : float
        Tolerance of the runs, relative.
    progress : bool or callable, optional
        True shows the progress in one line; a function is called with a line of text for each number.

    Returns
    -------
    Sensitivity
        Derivatives and errors in SI, NaN where there is no derivative, with a sentence that says why.

    Raises
    ------
    InputError
        If a name is unknown, a time lies outside the run, or the run has no such event.
    KeyboardInterrupt
        If the user presses Ctrl-C.

    Notes
    -----
    Six runs beside the problem's own give central differences of orders 2, 4 and 6, at steps that are tried until the error ceases
    to fall. The error is the difference between the last two orders, and the noise of the runs. There is no derivative where the
    runs have not had the same changes of the contact (slip, rest, jumps) in the same order: where an event grazes, appears or
    vanishes, or moves across the time.

    Examples
    --------
    >>> import stickslip as ss
    >>> block = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0)
    >>> problem = ss.Problem(block, ss.friction.Coulomb(0.6, 0.4), pull_rate=0.1, initial_load=0.0)
    >>> found = ss.studies.sensitivity(problem, ["stiffness", "mass"], "start", event=0, duration=0.5)
    >>> print([f"{one:.6g}" for one in found.derivatives[:, 0]])  # slip begins at 6 N / (stiffness x pull rate)
    ['-6e-05', '0']
    """
    chosen, own_rtol = _scenario_of(problem, duration), float(MEMBER_RTOL.check("sensitivity", "rtol", rtol))
    parameters = _numbers(chosen.problem, to)
    with telling(progress, "sensitivity") as tell:
        run = member_run(chosen.problem, chosen.duration, own_rtol, chosen.max_events)
        if not run.status.ok:
            raise InputError(f"sensitivity: the run ended early, at {brief(run.duration, 's')}: {run.status}")
        output = _output(run, of, at, event, chosen.duration)
        base = output.of(run)
        assert base is not None, "the output was chosen for this run"
        differences, found = Differences(chosen.problem, output, base, own_rtol), []
        for parameter in parameters:
            found.append(differences.by(parameter))
            tell(f"{parameter.name}, {len(found)} of {len(parameters)} numbers, {differences.runs} runs")
    return Sensitivity(chosen, output, base.values, tuple(found))


def _scenario_of(source: Source, duration: float | str | WithUnit | None) -> Scenario:
    """Return the scenario of whatever is given. Raises InputError."""
    if isinstance(source, Solution):
        source = Scenario(source.problem, source.duration, title=source.title)
    elif isinstance(source, Problem) and duration is None:
        raise InputError("sensitivity: a problem has no duration: give one, as in duration=10.0")
    return read_source("sensitivity", source, duration)


def _numbers(problem: Problem, to: str | Sequence[str] | None) -> list[Parameter[Problem]]:
    """Return the numbers with these names, or all that are not 0. Raises InputError."""
    known = problem.parameters
    if to is None:
        return [one for one in known.values() if one.value != 0.0 and np.isfinite(one.value) and not one.declared.whole]
    names = [to] if isinstance(to, str) else list(to) if isinstance(to, Sequence) else []
    if not names:
        raise InputError('sensitivity: to: give the name of a number, such as "stiffness", or several in a list')
    found: list[Parameter[Problem]] = []
    for name in names:
        try:
            one = known[name]
        except InputError as error:
            raise InputError(f"sensitivity: {error}") from None
        if one.declared.whole or not np.isfinite(one.value):
            kind = "a whole number" if one.declared.whole else "infinite"
            raise InputError(f"sensitivity: {one.name} is {kind}: it has no values close to it, and nothing a derivative by it")
        if any(one.name == other.name for other in found):
            raise InputError(f"sensitivity: {one.name} is given twice")
        found.append(one)
    return found


def _output(run: Solution, of: str, at: ArrayLike | None, event: int | None, lasts: float) -> Output:
    """Return the output that is asked for. Raises InputError."""
    curves = curves_of(run.problem)
    if of in curves and event is None:
        return CurveAtTimes(of, _times(run, at))
    if of in EVENT_NUMBERS:
        if at is not None:
            raise InputError(f"sensitivity: at: '{of}' is a number of a slip event, which event= chooses: leave at out")
        return _number(run, of, event, lasts)
    if of in curves:
        raise InputError(f"sensitivity: of: '{of}' is no number of a slip event; {nearest(of, EVENT_NUMBERS)}, or leave event out")
    if of in WITHOUT_SLOPE:
        raise InputError(f"sensitivity: of: '{of}' has no derivative, because it counts, or is what a division leaves")
    if of in (*STATE_NAMES, "surface_torque"):
        getattr(run, of)()  # which says why this run has none
    raise InputError(f"sensitivity: of: {shown(of)} is unknown; {nearest(str(of), dict.fromkeys((*curves, *EVENT_NUMBERS)))}")


def _number(run: Solution, of: str, event: int | None, lasts: float) -> NumberOfEvent:
    """Return a number of a slip event of a run that was to last so long (s). Raises InputError if there is none."""
    rate = default_event_rate(run.problem)
    count = len(SlipEvents.of(run.history, rate).pulses)
    if not count or (event is not None and not -count <= event < count):
        has = f"{count}, 0 to {count - 1}" if count else "none"
        raise InputError(
            f"sensitivity: event: the run of {brief(run.duration, 's')} has no slip event{'' if event is None else f' {event}'}:"
            f" it has {has}"
        )
    for n in range(count) if event is None else (event % count,):
        found = NumberOfEvent(of, n, rate, lasts, run.max_events)
        if found.of(run) is not None:
            return found
    which = "no event" if event is None else f"event {event % count}"
    why = "the first has none" if of == "recurrence" else "an event that is not over has none"
    raise InputError(
        f"sensitivity: {which} of the run has the number '{of}': {why}"
        if event is None
        else f"sensitivity: {which} of the run has no '{of}': {why}"
    )


def _times(run: Solution, at: ArrayLike | None) -> Floats:
    """Return the times (s) of a curve. Raises InputError if one lies outside the run."""
    begin, end = run.history.span
    if at is None:
        return np.linspace(begin, end, EVEN_TIMES + 2)[1:-1]
    times = np.unique(np.atleast_1d(times_of(at)).ravel())
    if not len(times) or not np.all((times >= begin) & (times <= end)):
        raise InputError(f"sensitivity: at: times must lie between {brief(begin, 's')} and the end of the run, {brief(end, 's')}")
    if times[-1] == begin:
        raise InputError("sensitivity: at: give a time after the start of the run")
    return times
