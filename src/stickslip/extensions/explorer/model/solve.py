"""Answer a scenario: run it and its companion, and work out all that the explorer shows of them."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

from stickslip.contact import Uniqueness, uniqueness_of
from stickslip.extensions.explorer.model.answer import Answer, BodyCurves, RecordBehind, StateCurve, measured_of
from stickslip.extensions.explorer.model.asked import SHOWN_KINDS
from stickslip.extensions.explorer.model.findings import Findings, key_numbers, marks_of, sentence
from stickslip.extensions.explorer.model.pictures import contact_picture, energy_picture, law_picture
from stickslip.extensions.explorer.model.sampled_waves import ShownInterval
from stickslip.foundation.errors import InputError
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import Problem, in_given_units
from stickslip.problem.scenarios import Scenario
from stickslip.run.check import warnings_of
from stickslip.run.simulate import simulate
from stickslip.solution import Solution

Told = Callable[[str], None]
"""A function that is told in one line how far a run is, some ten times a second. It raises `Stopped` to end the run there."""


class Stopped(KeyboardInterrupt):
    """Raised where a run reports its progress: the run ends with a valid solution up to there, as after Ctrl-C."""


def silent(_: str) -> None:
    """Ignore a report of progress."""


MOST_PIECES = 100_000
"""Largest number of pieces of a history: some 45 MB, so that several pages fit into memory."""


def run(scenario: Scenario, told: Told) -> Solution:
    """Run a scenario, with a bounded history. Raises InputError if it cannot even start, or was stopped before it did."""
    try:
        return simulate(scenario, progress=lambda report: told(str(report)), max_pieces=MOST_PIECES)
    except Stopped:
        raise InputError(f"{scenario.name}: stopped before the run had begun") from None


def companion_of(scenario: Scenario) -> Scenario | None:
    """Return the scenario of the companion, or None if there is none.

    For a slab it is its equivalent block, for each m^2 of contact, so that its forces in N are the slab's stresses in Pa. For a
    block of the paper it is the slab of the same figure, under the law, the loading and the rule of the block.
    """
    try:
        return SHOWN_KINDS[scenario.problem.body.structure].companion(scenario)
    except InputError:  # such as a driver that is not rigid
        return None


def run_companion(scenario: Scenario, told: Told) -> Solution | None:
    """Run the companion of a scenario, or return None if it has none, or if its run cannot start."""
    other = companion_of(scenario)
    try:
        return None if other is None else run(other, lambda text: told(f"{_beside_name(other.problem)}: {text}"))
    except InputError:
        return None


def _beside_name(problem: Problem) -> str:
    """Return what the legend calls the companion of a body."""
    return f"{SHOWN_KINDS[problem.body.structure].beside}{problem.body.noun}"


PIECES_OF_LONG_RUN = 5_000
"""From this many pieces of a run on, its pictures take so long that their progress is reported."""


@in_given_units
def solve(scenario: Scenario, told: Told = silent, behind: RecordBehind | None = None) -> Answer:
    """Run a scenario, with a record drawn behind it if there is one, and return all that the explorer shows of it, in SI units.

    `told` is called with a line on the progress of a long run. If it raises `Stopped` the run ends there, and the answer shows it
    up to there. Raises InputError, in one line, if the run cannot even start.
    """
    contact = uniqueness_of(scenario.problem)
    solution = run(scenario, told)
    companion = None if solution.status.name == "interrupted" else run_companion(scenario, told)
    runs = (solution,) if companion is None else (solution, companion)
    is_long = max(len(one.history) for one in runs) > PIECES_OF_LONG_RUN
    answer = answer_of(scenario, solution, companion, contact, partial(_tell, told) if is_long else silent)
    return answer if behind is None else _with_record(answer, behind)


def _with_record(answer: Answer, behind: RecordBehind) -> Answer:
    found = measured_of(behind.beside(answer.solution))
    return replace(
        answer, measured=found, sentence=f"{answer.sentence} {found.sentence}", numbers=(*answer.numbers, *found.misfits)
    )


def _tell(told: Told, text: str) -> None:
    """Tell how far the pictures are; a stop ends the run, and what there is of it is shown whole."""
    with suppress(Stopped):
        told(text)


def answer_of(
    scenario: Scenario, solution: Solution, companion: Solution | None, contact: Uniqueness, told: Told = silent
) -> Answer:
    """Return what is shown of finished runs; `told` learns what is worked out next, and may raise to end that."""
    told("the run is finished; looking for slip events and pulses")
    found = Findings.of(solution)
    told("the run is finished; drawing its curves")
    own, influence, shown = motion(solution), solution.rule_influence, ShownInterval.of(solution)
    beside = _beside(companion)
    told("the run is finished; working out the inside of the body")
    of_kind = SHOWN_KINDS[shown.readings.problem.body.structure]
    waves = of_kind.waves(shown)
    slab = of_kind.inside(shown, waves)
    told("the run is finished; working out the energy")
    energy = energy_picture(shown, waves)
    told("the run is finished; finding its words")
    return Answer(
        scenario=scenario,
        solution=solution,
        companion=companion,
        regime=influence.regime,
        sentence=sentence(found, contact, influence),
        law=law_picture(solution, own),
        contact=contact_picture(contact, own),
        motions=(own, *beside),
        slab=slab,
        energy=energy,
        marks=marks_of(found, own),
        numbers=key_numbers(found, contact, own),
        notes=notes_of(scenario, solution, contact),
    )


def _beside(companion: Solution | None) -> tuple[BodyCurves, ...]:
    if companion is None:
        return ()
    return (motion(companion, _beside_name(companion.problem)),)


def notes_of(scenario: Scenario, solution: Solution, contact: Uniqueness) -> tuple[str, ...]:
    """Return warnings on a scenario and its run, one line each."""
    ended = [] if solution.status.ok else [f"{solution.status} (it reached {solution.span_text})"]
    of_run = (solution.creep_note, solution.lumping_note, solution.rounding_note)
    return (*ended, *(note for note in of_run if note), *warnings_of(scenario, contact))


EVEN_TIMES = 400
"""Number of evenly spaced times; the breaks of a run, and times between them, are added, so that there are some thousands."""


def motion(solution: Solution, name: str = "") -> BodyCurves:
    """Return the motion of one body; `name` is what the legend calls it, by default that of the body."""
    has_waves = solution.problem.body.has_waves
    known = solution.problem.friction.states
    names: tuple[Any, ...] = ("slip", "slip_rate", "traction", "load", *STATE_NAMES[: len(known)])
    time, (slip, rate, traction, load, *states) = solution.curves_together(names, points=EVEN_TIMES)
    return BodyCurves(
        body="slab" if has_waves else "block",
        name=name or solution.problem.body.noun,
        time=time,
        slip=slip,
        slip_rate=rate,
        traction=traction,
        load=load,
        load_unit=solution.problem.load_unit,
        normal_load=solution.problem.normal,
        states=tuple(StateCurve(one.meaning, one.unit, values) for one, values in zip(known, states, strict=True)),
    )
