"""Give parameters of a scenario other values."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from stickslip.foundation.errors import InputError
from stickslip.scenarios.entries import Source
from stickslip.scenarios.parameter_paths import EXCLUDE_EACH_OTHER, find_parameter
from stickslip.scenarios.scenario import Scenario, scenario_of
from stickslip.scenarios.values import show, typed_number


def with_values(scenario: Scenario, values: Mapping[str, Any], where: str) -> Scenario:
    """Return a scenario in which some parameters have other values.

    Parameters
    ----------
    scenario : Scenario
        The scenario; it stays as it is.
    values : mapping of str to float or str
        Values by the names of parameters, as in `stickslip.sweep`: numbers in SI, texts with a unit, or words.
    where : str
        First words of messages.

    Returns
    -------
    Scenario
        A new scenario. Its title tells what was changed; the description, which may no longer be true, is left out. An initial load
        replaces an initial excess, and an excess a load.

    Raises
    ------
    InputError
        If there is no such parameter, or if it cannot have the value.
    """
    document = tomllib.loads(scenario.to_toml())
    for name, value in values.items():
        parameter = find_parameter(scenario, name, where)
        document["initial"].pop(EXCLUDE_EACH_OTHER.get(parameter.name), None)
        parameter.put(document, parameter.read(value, where))
    changed = ", ".join(f"{name} = {value}" for name, value in values.items())
    title = f"{scenario.heading}: {changed}" if scenario.heading else changed
    return replace(scenario_of(document, Source(where)), name=scenario.name, title=title, description="")


def with_typed_values(scenario: Scenario, texts: Iterable[str], where: str) -> Scenario:
    """Return a scenario with the values that were typed, each as NAME=VALUE, such as "body.thickness=5 km".

    Raises InputError, whose message begins with `where`.
    """
    values: dict[str, Any] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name or not value:
            raise InputError(f'{where} must be NAME=VALUE, as "friction.alpha=2" or "body.thickness=5 km", got {show(text)}')
        if name in values:
            raise InputError(f"{where}: {show(name)} is given twice")
        values[name] = typed_number(value)
    return with_values(scenario, values, where) if values else scenario
