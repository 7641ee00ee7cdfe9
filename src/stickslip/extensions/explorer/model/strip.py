"""A strip: what a few hundred runs of one setting give while a single parameter moves through a range.

The runs are those of a sweep, and a page has no strip where the extension for sweeps is not there. Where the compiled batch can do
them, two hundred take a few hundredths of a second; scenarios that it cannot do are run one after the other, with a line on the
progress.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stickslip.extension import is_there
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import Stopped
from stickslip.foundation.arrays import Floats
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.problem import PRESSING
from stickslip.problem.scenarios import ParameterPath, Scenario, find_parameter, put_into, values_in
from stickslip.problem.scenarios.parameter_paths import parameter_paths

Told = Callable[[str], None]

MEMBERS = 200
"""Number of runs in a strip: about one for each four pixels of a page."""
SHOWN = ("pulses", "slip", "first_end", "peak_rate")
"""The quantities of a strip that are drawn, by their names in a sweep; `first_end` is the time of the first arrest."""
KEPT = (*SHOWN, "irregular")


def strip_range(parameter: str, low: float, high: float, *, log: bool = False) -> Axis:
    """Return the range that a strip covers: a parameter by its place in a scenario file, and its ends in SI. Raises InputError."""
    return Axis(parameter, low, high, MEMBERS, log)


@dataclass(frozen=True)
class Strip:
    """The results of the runs of a strip, in the order of the `values` (SI) of the parameter that moves.

    `here` is its value in the setting that the strip was made from; NaN if the setting has none. `results` are the quantities
    `SHOWN`, and "irregular": 1 where several slip rates solve the contact equation; NaN for runs that failed. `refused` says why,
    in one line, by the number of the run. Units are in SI, "1" for a pure number.
    """

    parameter: str
    meaning: str
    unit: str
    values: Floats
    here: float
    log: bool
    results: Mapping[str, Floats]
    units: Mapping[str, str]
    refused: Mapping[int, str]

    def nearest(self, value: float) -> int:
        """Return the number of the run whose parameter is nearest to a value (SI), on the strip's own scale."""
        scaled: Any = np.log if self.log else np.asarray
        if self.log and value <= 0.0:
            return 0
        return int(np.argmin(np.abs(scaled(self.values) - scaled(value))))


def has_strips() -> bool:
    """Return True if strips can be made: their runs are made as a sweep makes them."""
    return is_there("sweeps")


def strip_of(scenario: Scenario, where: Axis, told: Told = lambda text: None) -> Strip:
    """Run a scenario for many values of one parameter.

    `told` is called with a line on the progress while runs are made one after the other; if it raises `Stopped`, the runs so far
    are the result. A run whose value makes no valid scenario, or that does not come to its end, has NaN and a reason. Raises
    InputError if there is no such parameter, or if it is a word and no number.
    """
    from stickslip.extensions.sweeps import run_along

    found, values = numeric(scenario, where.parameter), where.values

    def goes_on(done: int) -> bool:
        try:
            told(f"strip: {done} of {len(values)} runs")
        except Stopped:
            if not done:
                raise
            return False
        return True

    results, units, refused = run_along(scenario, found, values, KEPT, goes_on)
    return Strip(
        found.name, found.declared.meaning, found.unit, values, present(scenario, found), where.log, results, units, refused
    )


def present(scenario: Scenario, parameter: ParameterPath) -> float:
    """Return the value (SI) that a parameter has in a scenario; NaN if it has none, as the load where the excess is given."""
    if parameter.name == PRESSING:
        return scenario.problem.normal
    value = next((value for one, value in values_in(scenario) if one.name == parameter.name), None)
    return math.nan if value is None else float(parameter.read(value, "strip"))


def usual_range(scenario: Scenario, name: str) -> Axis:
    """Return the range of a strip that nobody has chosen: from a fifth of the present value to five times it, logarithmic.

    Around a value that is negative the range ends at zero, and around zero, or where no value is given, it is 0 to 1 in SI.
    """
    found = numeric(scenario, name)
    here = present(scenario, found)
    if here > 0.0 and math.isfinite(here):
        return strip_range(found.name, here / 5.0, here * 5.0, log=True)
    return strip_range(found.name, 2.0 * here, 0.0) if -math.inf < here < 0.0 else strip_range(found.name, 0.0, 1.0)


def numeric(scenario: Scenario, name: str) -> ParameterPath:
    """Return the parameter with this name, which must be one that varies continuously. Raises InputError."""
    found = find_parameter(scenario, name, "strip")
    if not is_continuous(found):
        what = "a whole number" if isinstance(found.declared, Quantity) else "a word"
        raise InputError(f"strip: {found.name} is {what}; a strip needs a parameter that varies continuously")
    return found


def strip_text(strip: Strip) -> str:
    """Return one line on a strip: what its parameter means, and how many runs failed."""
    return strip.meaning + (f"; {len(strip.refused)} runs failed: {next(iter(strip.refused.values()))}" if strip.refused else "")


def is_continuous(parameter: ParameterPath) -> bool:
    """Return True if a parameter is a number, and not a whole one."""
    return isinstance(parameter.declared, Quantity) and not parameter.declared.whole and parameter.name != "run.events"


def setting_at(setting: Setting, name: str, value: float) -> Setting:
    """Return a setting with another value (SI) of the parameter of a strip. Raises InputError if there is no such parameter."""
    scenario = setting.scenario()
    found = numeric(scenario, name)
    return replace(setting, document=put_into(setting.document, scenario, [(found, value)], "strip"))


def choices(scenario: Scenario) -> list[str]:
    """Return the parameters of a scenario through which a strip can go."""
    return [one.name for one in parameter_paths(scenario) if is_continuous(one)]
