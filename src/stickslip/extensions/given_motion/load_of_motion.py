"""The normal load of a [motion] and its unit, and the bodies that stand for the unit where a scenario has none."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from stickslip.foundation.arguments import shown
from stickslip.foundation.conversion import unit_among
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import read_part

if TYPE_CHECKING:
    from stickslip.problem.scenarios import Source

UNUSED_BODIES: dict[str, dict[str, Any]] = {
    "N": {"kind": "spring-block", "mass": 1.0, "stiffness": 1.0, "normal_force": 1.0},
    "Pa": {"kind": "elastic-slab", "density": 1e3, "wave_speed": 1e3, "thickness": 1.0, "normal_stress": 1e6},
    "N m": {"kind": "rotating-block", "inertia": 1.0, "stiffness": 1.0, "normal_torque": 1.0},
}
"""The [body] of a scenario that has none, by the unit of its normal load: nothing but that unit is used of it."""
UNITS_OF_LOAD = ", ".join(repr(one) for one in UNUSED_BODIES)
"""Units of a normal load, as they may be written."""


def with_load(motion: Mapping[str, Any], body: Any, source: Source) -> dict[str, Any]:
    """Return a [motion] with the unit of its normal load, and with that load: that of a [body] if it has none itself.

    Raises InputError if there is no load, or a unit of no load.
    """
    of_body = read_part("body", body, source) if isinstance(body, dict) else None
    load = motion.get("normal_load")
    unit = motion.get("load_unit", _unit_of(load) if of_body is None else of_body.load_unit)
    if unit not in tuple(UNUSED_BODIES):
        raise InputError(f"{source.file}: [motion] load_unit {shown(unit)} is unknown; allowed: {UNITS_OF_LOAD}")
    if load is None:
        if of_body is None:
            raise InputError(f"{source.file}: [motion] normal_load is missing: a number such as '100 N' or '5 MPa', or a history")
        load = f"{of_body.normal_load!r} {of_body.load_unit}"
    return dict(motion) | {"normal_load": load, "load_unit": unit}


def _unit_of(load: Any) -> str:
    """Return the unit of a normal load in a file: that of a text, or of the first text among the values of a history."""
    values = load.get("values", load.get("mean")) if isinstance(load, dict) else load
    for one in values if isinstance(values, list) else [values]:
        if found := unit_among(one, " or ".join(UNUSED_BODIES)):
            return found
    return "N"
