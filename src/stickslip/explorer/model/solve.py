"""Answer a scenario: run it and its companion, and work out all that the explorer shows of them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from functools import partial

from stickslip.contact.uniqueness import Uniqueness, uniqueness_of
from stickslip.explorer.model.answer import Answer, Motion
from stickslip.explorer.model.contact_picture import contact_picture
from stickslip.explorer.model.energy_picture import energy_picture
from stickslip.explorer.model.findings import Found, key_numbers, marks_of
from stickslip.explorer.model.law_picture import law_picture
from stickslip.explorer.model.measured import Backdrop
from stickslip.explorer.model.runs import run, run_companion
from stickslip.explorer.model.sampled_waves import SampledWaves, Shown
from stickslip.explorer.model.sentence import sentence
from stickslip.explorer.model.slab_picture import slab_picture
from stickslip.explorer.model.stop import Stopped, Told, silent
from stickslip.foundation.errors import InputError
from stickslip.scenarios.examine import warnings_of
from stickslip.scenarios.scenario import Scenario
from stickslip.solution.solution import Solution

LONG = 5_000
"""Number of pieces of a run from which on its pictures take long enough to be told of."""


def solve(scenario: Scenario, told: Told = silent, behind: Backdrop | None = None) -> Answer:
    """Run a scenario, with a record drawn behind it if there is one, and return all that the explorer shows of it, in SI units.

    `told` is called with a line on the progress of a long run. If it raises `Stopped` the run ends there, and the answer shows it
    up to there. Raises InputError, in one line, if the run cannot even start.
    """
    contact = uniqueness_of(scenario.problem)
    solution = run(scenario, told)
    companion = None if solution.status.name == "interrupted" else run_companion(scenario, told)
    runs = (solution,) if companion is None else (solution, companion)
    is_long = max(len(one.history) for one in runs) > LONG
    answer = answer_of(scenario, solution, companion, contact, partial(_tell, told) if is_long else silent)
    return answer if behind is None else _with_record(answer, behind)


def _with_record(answer: Answer, behind: Backdrop) -> Answer:
    """Return an answer with a record behind its run, whose misfit is among its words and numbers."""
    found = behind.behind(answer.solution)
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
    found = Found.of(solution)
    told("the run is finished; drawing its curves")
    own, influence, shown = motion(solution), solution.rule_influence, Shown.of(solution)
    beside = _beside(companion)
    told("the run is finished; working out the inside of the body")
    waves = _waves(shown)
    slab = None if waves is None else slab_picture(waves)
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


def _waves(shown: Shown) -> SampledWaves | None:
    """Return the waves in the slab; None for a block, and where they are not known because the run leaped over creep."""
    if not shown.readings.problem.body.has_waves:
        return None
    try:
        return SampledWaves(shown)
    except InputError:
        return None


def _beside(companion: Solution | None) -> tuple[Motion, ...]:
    if companion is None:
        return ()
    return (motion(companion, "slab" if companion.problem.body.has_waves else "equivalent block"),)


def notes_of(scenario: Scenario, solution: Solution, contact: Uniqueness) -> tuple[str, ...]:
    """Return warnings on a scenario and its run, one line each."""
    ended = [] if solution.status.ok else [str(solution.status)]
    of_run = (solution.creep_note, solution.lumping_note, solution.rounding_note)
    return (*ended, *(note for note in of_run if note), *warnings_of(scenario, contact))


EVEN_TIMES = 400
"""Number of evenly spaced times; the breaks of a run, and times between them, are added, so that there are some thousands."""


def motion(solution: Solution, name: str = "") -> Motion:
    """Return the motion of one body; `name` is what the legend calls it, by default "slab" or "block"."""
    has_waves = solution.problem.body.has_waves
    time, (slip, rate, traction, load) = solution.curves_together(("slip", "slip_rate", "traction", "load"), points=EVEN_TIMES)
    return Motion(
        body="slab" if has_waves else "block",
        name=name or ("slab" if has_waves else "block"),
        time=time,
        slip=slip,
        slip_rate=rate,
        traction=traction,
        load=load,
        load_unit="Pa" if has_waves else "N",
        normal_load=solution.problem.normal,
    )
