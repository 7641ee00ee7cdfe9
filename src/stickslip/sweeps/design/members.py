"""The scenario of one member of a sweep: the document of the swept scenario with other values, read like any scenario file."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Mapping
from typing import Any

from stickslip.scenarios.entries import Source
from stickslip.scenarios.scenario import Scenario, scenario_of
from stickslip.sweeps.design.parameter_paths import Key

EXCLUDE_EACH_OTHER = {"initial.load": "excess", "initial.excess": "load"}
"""A scenario has either an initial load or an initial excess. The one that is varied replaces the other."""
_STEP = re.compile(r"(?P<name>[^\[]+)(?:\[(?P<index>\d+)\])?")


class Members:
    """A factory of member scenarios, from the text of the swept scenario (TOML, in SI) and the `keys` that vary."""

    def __init__(self, text: str, keys: tuple[Key, ...]) -> None:
        self.document = tomllib.loads(text)
        self.keys = keys
        for key in keys:
            self.document["initial"].pop(EXCLUDE_EACH_OTHER.get(key.name), None)

    def scenario(self, values: Mapping[str, float | str]) -> Scenario:
        """Return the scenario of the member with these values (SI).

        Raises InputError with the same one-line message as a scenario file that cannot be used.
        """
        document = copy.deepcopy(self.document)
        for key in self.keys:
            _put(document, key, values[key.name])
        return scenario_of(document, Source("member"))


def _put(document: dict[str, Any], key: Key, value: float | str) -> None:
    *tables, last = key.name.split(".")
    for table in tables:
        document = document[table]
    found = _STEP.fullmatch(last)
    assert found
    if found["index"]:
        document[found["name"]][int(found["index"])] = value
    else:
        document[last] = _written(key, value)


def _written(key: Key, value: float | str) -> Any:
    if key.written:
        return f"{value!r} {key.written}"
    if key.name == "run.events" and isinstance(value, float) and value.is_integer():
        return int(value)
    return value
