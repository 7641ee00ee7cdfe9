"""Load a scenario, replace its numbers by those that were typed as options of a command, and read the axes of its maps."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, meant
from stickslip.foundation.given import show_in
from stickslip.problem import Accelerogram, Problem, read_option, units_given
from stickslip.problem.scenarios import (
    LARGEST_SCENARIO_FILE,
    Scenario,
    check_rule,
    check_solved_by_core,
    fields_of_file,
    load_scenario,
    read_scenario,
    read_typed,
    text_of,
    typed_number,
    with_values,
)

if TYPE_CHECKING:
    from stickslip.foundation.axis import Axis

CALLED = {"max_events": "events"}
"""Options of a run whose name on the command line is that of scenario files."""
GROUND = "loading.ground_acceleration"
"""What --set takes the file of a record for."""
STDIN = "-"
"""The name that stands for standard input in place of a scenario's."""


def load(scenario: str, command: str, changes: Sequence[str] | None = None, *, any_kind: bool = False) -> Scenario:
    """Load a scenario from a file, by its bundled name, or from standard input, with the values of --set.

    Raises InputError, also for a scenario whose own problem is not what is solved unless it may be of `any_kind`.
    """
    loaded = _load(scenario)
    if not any_kind:
        check_solved_by_core(command, loaded)
    where = f"{command}: --set"
    if changes:
        values = typed_values(changes, where, '"friction.alpha=2" or "body.thickness=5 km"')
        several = next((name for name, value in values.items() if isinstance(value, str) and ".." in value), None)
        if several is not None:
            cure = "`stickslip sweep` runs a range: --vary NAME=LOW..HIGH:POINTS"
            raise InputError(f"{where}: {shown(several)} takes one value; {cure}")
        if GROUND in values:
            loaded = _on_ground_of(loaded, values.pop(GROUND), where)
        files = [name for name, value in values.items() if isinstance(value, str) and name.startswith("loading.")]
        if wrong := next((name for name in files if meant(name, [GROUND])), None):
            raise InputError(f"{where}: {shown(wrong)} is not a parameter of this scenario; did you mean {GROUND!r}?")
        loaded = with_values(loaded, values, where) if values else loaded
    show_in(units_given(loaded.problem))
    return loaded


def _on_ground_of(scenario: Scenario, file: float | str, where: str) -> Scenario:
    """Return a scenario whose ground moves as the record in a file says. Raises InputError."""
    if not isinstance(file, str):
        raise InputError(f"{where}: {GROUND} must be the file of a record, got {file:g}")
    record = Accelerogram(**fields_of_file(Path(file), {}, None))
    title = f"{scenario.heading}: {Path(file).name}" if scenario.heading else Path(file).name
    return replace(
        scenario, problem=replace(scenario.problem, ground_acceleration=record, ground_velocity=None), title=title, description=""
    )


def _load(scenario: str) -> Scenario:
    if scenario != STDIN:
        return load_scenario(scenario)
    if sys.stdin.isatty():
        typer.echo("the scenario is read from the terminal; its end is Ctrl-D on a line of its own", err=True)
    return read_scenario(
        text_of(sys.stdin.buffer.read(LARGEST_SCENARIO_FILE + 1), "standard input"), "standard input", "stdin", Path.cwd()
    )


def load_with(
    command: str, scenario: str, changes: Sequence[str] | None = None, *, any_kind: bool = False, **typed: Any
) -> Scenario:
    """Load a scenario and replace what was typed, by option, such as duration="480 years"; None is not typed.

    `changes` are the values of --set, which come first. Raises InputError as `load` does.
    """
    loaded = load(scenario, command, changes, any_kind=any_kind)
    if (rule := typed.pop("selection", None)) is not None:
        loaded = replace(loaded, problem=replace(loaded.problem, selection=check_rule(rule, command, "--selection")))
    found = loaded.with_given({name: typed_option(name, value, command) for name, value in typed.items()})
    found.check_with(found.problem, command, option_for)
    return found


def option_for(name: str) -> str:
    """Return how an option of a run is typed."""
    return f"--{CALLED.get(name, name).replace('_', '-')}"


def typed_option(name: str, value: Any, command: str) -> Any:
    """Return an option of a run that was typed, a number or a text with a unit; None is not typed. Raises InputError."""
    number = typed_number(value) if isinstance(value, str) else value
    return None if value is None else read_option(name, number, command, option_for(name))


def typed_values(texts: Iterable[str], where: str, example: str) -> dict[str, float | str]:
    """Return values that were typed, each as NAME=VALUE, by name: numbers, and texts with a unit or words.

    Raises InputError, whose message begins with `where` and shows the example.
    """
    typed = _by_name(texts, where, f"NAME=VALUE, as {example}")
    return {name: typed_number(_without_quotes(value)) for name, value in typed.items()}


def typed_columns(texts: Iterable[str] | None, where: str) -> dict[str, str]:
    """Return headings that were typed, each as NAME=HEADING, by the column that they are. Raises InputError."""
    return _by_name(texts or (), where, 'NAME=HEADING, as load_point="Vert_disp (micron)"')


def _by_name(texts: Iterable[str], where: str, form: str) -> dict[str, str]:
    """Return what was typed behind each name and "=". Raises InputError, which shows the form."""
    found: dict[str, str] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name or not value:
            raise InputError(f"{where} must be {form}, got {shown(text)}")
        if name in found:
            raise InputError(f"{where}: {shown(name)} is given twice")
        found[name] = value
    return found


def _without_quotes(value: str) -> str:
    """Return a value without the quotation marks that belong around it in TOML, and that not every shell takes off."""
    return value[1:-1] if len(value) > 2 and value[0] == value[-1] and value[0] in "\"'" else value


def read_axis(problem: Problem, text: str, where: str) -> Axis:
    """Read an axis of the form NAME=LOW..HIGH[:POINTS][:log], with numbers in SI or with a unit.

    The axis has 40 points if no number is given. Raises InputError with a message that begins with `where`.
    """
    from stickslip.foundation.axis import Axis, TypedRange  # here, because only maps have axes

    name, _, ends = text.partition("=")
    typed = TypedRange.of(ends, f"{where}: {shown(name.strip())}")
    if typed is None:
        raise InputError(f'{where} must be NAME=LOW..HIGH[:POINTS][:log], as "friction.alpha=0.01..10:50:log", got {shown(text)}')
    try:
        found = problem.parameters[name.strip()]
        low, high = (read_typed(end, found.declared, where, found.name) for end in (typed.low, typed.high))
        return Axis(found.name, low, high, 40 if typed.points is None else typed.points, typed.log)
    except InputError as error:
        message = str(error)
        raise InputError(message if message.startswith(where) else f"{where}: {message}") from None
