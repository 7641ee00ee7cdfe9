"""Replace numbers of a scenario by those that were typed as options of a command."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import typer

from stickslip.engine_input.creep_limits import check_creep_rtol
from stickslip.engine_input.lumping_limits import check_shortest_event
from stickslip.problem.problem import Problem
from stickslip.problem.run_quantities import SHORTEST_EVENT, check_rtol
from stickslip.scenarios.scenario import Scenario, load_scenario, read_scenario
from stickslip.scenarios.schema import check_events, check_rule, read_duration
from stickslip.scenarios.text_of_files import LARGEST, text_of
from stickslip.scenarios.values import read_typed

Reader = Callable[[Any, str, str], Any]
"""A function that converts what was typed, given also the name of the command and of the option for messages."""


STDIN = "-"
"""The name that stands for standard input in place of a scenario's."""


def load(scenario: str, command: str = "", changes: Sequence[str] | None = None) -> Scenario:
    """Load a scenario from a file, by its bundled name, or from standard input, with the values of --set. Raises InputError."""
    loaded = _load(scenario)
    if not changes:
        return loaded
    from stickslip.scenarios.other_values import with_typed_values

    return with_typed_values(loaded, changes, f"{command}: --set")


def _load(scenario: str) -> Scenario:
    if scenario != STDIN:
        return load_scenario(scenario)
    if sys.stdin.isatty():
        typer.echo("the scenario is read from the terminal; its end is Ctrl-D on a line of its own", err=True)
    return read_scenario(text_of(sys.stdin.buffer.read(LARGEST + 1), "standard input"), "standard input", "stdin", Path.cwd())


def load_with(command: str, scenario: str, changes: Sequence[str] | None = None, **typed: Any) -> Scenario:
    """Load a scenario and replace what was typed, by option, such as duration="480 years"; None is not typed.

    `changes` are the values of --set, which come first. Raises InputError.
    """
    loaded = load(scenario, command, changes)
    readers = _readers(loaded.problem)
    replaced = {}
    for option, value in typed.items():
        if value is not None:
            field, reader = readers[option]
            replaced[field] = read(reader, value, command, option)
    return replace(loaded, **replaced)


def read(reader: Reader, value: Any, command: str, option: str, default: Any = None) -> Any:
    """Return the value of an option, or the default if it is None. Raises InputError, which names the command and the option."""
    return default if value is None else reader(value, command, f"--{option.replace('_', '-')}")


def _readers(problem: Problem) -> dict[str, tuple[str, Reader]]:
    """Return by option the field of a scenario that it replaces, and the function that reads it."""
    return {
        "duration": ("duration", read_duration),
        "events": ("max_events", check_events),
        "rtol": ("rtol", check_rtol),
        "creep_rtol": ("creep_rtol", partial(check_creep_rtol, problem)),
        "shortest_event": ("shortest_event", partial(_shortest_event, problem)),
        "selection": ("problem", partial(_under_rule, problem)),
    }


def _shortest_event(problem: Problem, text: str, command: str, option: str) -> float | None:
    return check_shortest_event(problem, read_typed(text, SHORTEST_EVENT, command, option), command, option)


def _under_rule(problem: Problem, rule: str, command: str, option: str) -> Problem:
    return replace(problem, selection=check_rule(rule, command, option))
