"""What quantities are called, in one place: name, symbol, unit and meaning of each, and the units in which numbers are readable.

Files, figures, tables, the explorer and records read this. A unit may depend on the body: `KINDS_OF_BODY` has a row for each unit
of loads (`Body.load_unit`), and a body whose loads have another unit needs one more row there.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache
from typing import Any, NamedTuple

import numpy as np

from stickslip.foundation.constants import YEAR
from stickslip.foundation.given import preferred


@dataclass(frozen=True)
class KindOfBody:
    """What depends on the unit of a body's loads: the units of slip and energy, what loads are called, and other names."""

    slip: str
    energy: str
    loads: str
    normal: str
    """The field of a body, and the heading of a column, with the normal load."""
    impedance: str
    names: Mapping[str, str] = field(default_factory=dict)
    """Names of quantities where they differ from those in `QUANTITIES`."""
    moves: str = "slides"
    """What a contact does, for messages."""


KINDS_OF_BODY = {
    "Pa": KindOfBody("m", "J/m^2", "stress", "normal_stress", "Pa s/m"),
    "N": KindOfBody(
        "m",
        "J",
        "force",
        "normal_force",
        "N s/m",
        {"traction": "friction force", "load": "spring force", "drive_traction": "force at the driver"},
    ),
    "N m": KindOfBody(
        "rad",
        "J",
        "torque",
        "normal_torque",
        "N m s",
        {
            **{"slip": "angle", "event_slip": "angle in the event", "slip_rate": "rotation rate"},
            **{"peak_rate": "peak rotation rate", "traction": "friction torque", "load": "load torque"},
            **{"displacement": "angle", "velocity": "rotation rate", "stress": "torque"},
            **{"drive_rate": "rotation rate of the drive", "drive_traction": "surface torque"},
        },
        "turns",
    ),
}
"""Each kind of body by the SI unit of its loads: a slab's are stresses, a block's are forces, those of what turns are torques."""


class Name(NamedTuple):
    """Name and symbol (mathtext without dollar signs) of a quantity, its SI unit, and its meaning in files.

    The unit may be "slip", "slip_rate", "load", "load_rate", "stiffness", "impedance" or "energy": it then depends on the body.
    """

    name: str
    symbol: str
    unit: str
    meaning: str = ""


TURNS = "N m"
"""Unit of the loads of bodies that turn."""

QUANTITIES = {
    "time": Name("time", "t", "s", "time since the start of the run"),
    "slip": Name("slip", "u", "slip", "slip of the contact, u"),
    "event_slip": Name("slip in the event", r"\Delta u", "slip", "slip of the contact since the start of the event"),
    "slip_rate": Name("slip rate", "v", "slip_rate", "slip rate of the contact, v"),
    "traction": Name("traction", r"\tau", "load", "friction on the contact, tau"),
    "load": Name("load", r"\beta", "load", "load on the contact, beta"),
    "drive_rate": Name("drive rate", r"v_d", "slip_rate", "rate at the driver"),
    "drive_traction": Name("traction at the driver", r"\tau_d", "load", "load at the driver"),
    "surface_torque": Name("surface torque", "T_d", "N m", "torque at the drive"),
    "friction": Name("friction coefficient", r"\mu", "1"),
    "state": Name("state", "", "1", "state of the friction law"),
    "second_state": Name("second state", "", "1", "second state of the friction law"),
    "shear_stress": Name("shear stress", r"\tau", "Pa"),
    "shear_force": Name("shear force", "F", "N"),
    "torque": Name("torque", "T", "N m"),
    "friction_peak": Name("peak friction", r"\mu_p", "1"),
    "shear_stress_peak": Name("peak stress", r"\tau_p", "Pa"),
    "shear_force_peak": Name("peak force", "F_p", "N"),
    "torque_peak": Name("peak torque", "T_p", "N m"),
    "surface_torque_peak": Name("peak surface torque", "T_p", "N m"),
    "friction_rest": Name("friction at rest", r"\mu_r", "1"),
    "shear_stress_rest": Name("stress at rest", r"\tau_r", "Pa"),
    "shear_force_rest": Name("force at rest", "F_r", "N"),
    "torque_rest": Name("torque at rest", "T_r", "N m"),
    "surface_torque_rest": Name("surface torque at rest", "T_r", "N m"),
    "friction_drop": Name("drop of friction", r"\Delta\mu", "1"),
    "shear_stress_drop": Name("stress drop", r"\Delta\tau", "Pa"),
    "shear_force_drop": Name("drop of force", r"\Delta F", "N"),
    "torque_drop": Name("drop of torque", r"\Delta T", "N m"),
    "surface_torque_drop": Name("drop of surface torque", r"\Delta T", "N m"),
    "recurrence": Name("recurrence", "T", "s"),
    "duration": Name("duration", r"\delta t", "s"),
    "peak_rate": Name("peak slip rate", "v_{max}", "slip_rate"),
    "heat": Name("friction heat", "", "energy"),
    "displacement": Name("displacement", "u", "slip"),
    "velocity": Name("velocity", r"\dot u", "slip_rate"),
    "stress": Name("shear stress", r"\sigma", "load"),
}
"""The curves of a run by their names in `Solution.curve`, what a record may hold of samples and of slip events, heat, and the field
inside a body with waves.

The unit of a state is that of its law.
"""

GREEK = {
    **{"alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "eta": "η", "theta": "θ", "kappa": "κ", "lambda": "λ"},
    **{"mu": "μ", "nu": "ν", "xi": "ξ", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ", "psi": "ψ", "omega": "ω"},
}
"""Greek letters by the names under which declarations and formulas write them."""

_PREFIXES = ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))
_PREFIXED = ("Pa", "Pa/m", "Pa s/m", "Pa m/s", "N", "N/m", "N s/m", "N m/rad", "N m s", "N m^2", "J", "J/m²")
"""Units that are read with a prefix, besides those of loads."""
_READABLE = {
    "s": ((YEAR, "year"), (86_400.0, "day"), (1.0, "s"), (1e-3, "ms"), (1e-6, "µs")),
    "m": ((1e3, "km"), (1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")),
    "m/s": ((1.0, "m/s"), (1e-3, "mm/s"), (1e-6, "µm/s"), (1e-9, "nm/s")),
}
"""Readable units of other SI units, the largest first: size in SI units and name."""
_SHORT = {
    "m": (("km", 1e3), ("mm", 1e-3), ("um", 1e-6)),
    "s": (("years", YEAR), ("ms", 1e-3)),
    "m/s": (("km/s", 1e3), ("mm/s", 1e-3), ("um/s", 1e-6), ("m/year", 1.0 / YEAR)),
    "rad": (("deg", math.pi / 180.0),),
    "rad/s": (("rpm", math.pi / 30.0),),
}
"""Units, with their sizes in SI units, among which the shortest text of one number is looked for (`show.brief`)."""
_FACTOR = re.compile(r"([A-Za-zµ%]+)\^?(-?[1-9]|)")
"""A name in a unit, with its power: m, s-1 of files, s^-1."""
_SUPERSCRIPTS = str.maketrans("123456789", "¹²³⁴⁵⁶⁷⁸⁹")
DECADES = 1e6
"""A logarithmic axis that spans more than this factor has the SI unit: a prefix would not make its powers of ten more readable."""


@lru_cache(maxsize=1024)
def si_unit(what: str, *load_units: str) -> str:
    """Return the SI unit of a quantity, or of what a column names in place of a unit, for bodies whose loads have these units.

    Any other text is a unit already. Different units are joined, as in "Pa or N"; by default they are those of all kinds of bodies.
    """
    known = QUANTITIES[what].unit if what in QUANTITIES else what
    return " or ".join(dict.fromkeys(_of_kind(load).get(known, known) for load in load_units or KINDS_OF_BODY))


@cache
def _of_kind(load_unit: str) -> Mapping[str, str]:
    """Return the units of a kind of body by the words that columns name in their place."""
    kind = KINDS_OF_BODY[load_unit]
    units = {"slip": kind.slip, "slip_rate": f"{kind.slip}/s", "slip_acceleration": f"{kind.slip}/s^2"}
    units |= {"load": load_unit, "load_rate": f"{load_unit}/s", "stiffness": f"{load_unit}/{kind.slip}"}
    return units | {"impedance": kind.impedance, "energy": kind.energy}


@cache
def own_units(load_unit: str) -> Mapping[str, str]:
    """Return the units that take the place of those in which laws, loading histories and problems are declared.

    Declared are m, m/s, m/s^2, s/m, 1/m, Pa and Pa/s, and "Pa or N or N m" for a load; a body whose loads have the unit `load_unit`
    may slip by an angle.
    """
    slip = KINDS_OF_BODY[load_unit].slip
    units = {si_unit("load"): load_unit}
    if slip != "m":
        units |= {one: one.replace("m", slip) for one in ("m", "m/s", "m/s^2", "s/m", "1/m")}
        units |= {"Pa": load_unit, "Pa/s": f"{load_unit}/s"}
    return units


def name_of(quantity: str, load_unit: str = "Pa") -> str:
    """Return the name of a quantity for a body whose loads have this unit: "traction" is a "friction force" if it is N."""
    return KINDS_OF_BODY[load_unit].names.get(quantity, QUANTITIES[quantity].name)


def plain_symbol(quantity: str) -> str:
    """Return the symbol of a quantity as plain text, such as "τ"."""
    return re.sub(r"\\([a-z]+)", lambda found: GREEK[found[1]], QUANTITIES[quantity].symbol)


def in_files(unit: str) -> str:
    """Return a unit as the CF conventions spell it in files: "m s-1" for "m/s", "J m-2" for "J/m^2"."""
    return re.sub(r"/(\w+)\^?(\d?)", lambda found: f" {found[1]}-{found[2] or 1}", unit)


def for_readers(unit: str) -> str:
    """Return a unit, of a file, declared or in powers, as readers expect to see it: "m/s" for "m s-1", "kg/m³" for "kg/m^3"."""
    factors = [_FACTOR.fullmatch(one) for one in unit.split()]
    if any(one and one[2].startswith("-") for one in factors) and all(factors):
        over = [_raised(one[1], int(one[2] or 1)) for one in factors if one and not one[2].startswith("-")]
        below = [_raised(one[1], int(one[2][1:])) for one in factors if one and one[2].startswith("-")]
        unit = f"{' '.join(over) or '1'}/{below[0] if len(below) == 1 else '(' + ' '.join(below) + ')'}"
    return "m⁻¹" if unit == "1/m" else re.sub(r"(?<=/[ms])\^([23])$", lambda found: _raised("", int(found[1])), unit)


def _raised(name: str, power: int) -> str:
    return name + ("" if power == 1 else str(power).translate(_SUPERSCRIPTS))


def has_prefixes(unit: str) -> bool:
    """Return True for units that are read with a prefix, such as MPa."""
    return unit in _PREFIXED or unit in KINDS_OF_BODY


def sizes_of(unit: str) -> tuple[tuple[float, str], ...]:
    """Return the readable units of an SI unit, the largest first: size in SI units and name. A unit without others has none."""
    return tuple((size, prefix + unit) for size, prefix in _PREFIXES) if has_prefixes(unit) else _READABLE.get(unit, ())


def readable_unit(unit: str, *values: Any, log: bool = False, plain: bool = False, of: str = "") -> tuple[str, float]:
    """Return the unit (name, size in SI units) in which values (SI) are readable together: the largest that fits.

    Where quantities of this kind were given in a unit of a trade, such as rpm or inch, it is that one (`given.preferred`); `of` is
    "place" for lengths inside a body, which are of another kind than slip.
    The largest magnitude is at least one in it (s, m and m/s: a half). It is the SI unit if all values are 0 or the unit has no
    others, and on a logarithmic axis (`log`) for values that span more than `DECADES`. In plain text (`plain`) only prefixes for
    large numbers are taken, and the unit is left as it is spelled.
    """
    si, unit = unit, unit if plain else for_readers(unit)
    choice = [(size, name) for size, name in sizes_of(unit) if not plain or (has_prefixes(unit) and size >= 1.0)]
    known = np.concatenate([np.abs(np.ravel(np.asarray(one, float))) for one in values]) if values else np.zeros(0)
    known = known[np.isfinite(known) & (known > 0.0)]
    if given := preferred(of or si, float(known.max()) if known.size else None):
        return given
    if not choice or not known.size or (log and known.max() > DECADES * known.min()):
        return unit, 1.0
    least = 0.5 if unit in _READABLE else 1.0
    # A hair less than the bound, so that rounding does not decide about round numbers.
    found = next(((name, size) for size, name in choice if known.max() >= least * size * (1.0 - 1e-9)), None)
    return found or (choice[-1][1], choice[-1][0])


def short_units(unit: str) -> tuple[tuple[str, float], ...]:
    """Return the further units, with their sizes in SI units, in which the text of one number may be short."""
    return (
        tuple((name, size) for size, name in reversed(sizes_of(unit)) if size > 1.0) if has_prefixes(unit) else _SHORT.get(unit, ())
    )


ENERGY_NAMES = {
    "work": "work of the driver, and of moving ground",
    "stored": "elastic and kinetic energy",
    "elastic": "elastic energy",
    "kinetic": "kinetic energy, with those of a contact mass and of the driver's mass",
    "heat": "friction heat, from the law",
    "damped": "dissipated by damping of block or contact, or drag of layers",
    "radiated": "energy radiated through a driver of finite impedance; work is net of it",
    "balance": "work - stored - heat - damped: zero for an exact solution",
    "trapped": "energy of the waves inside the body, beyond a state of uniform stress",
    "elastic_in_layer": "elastic energy in each layer",
    "kinetic_in_layer": "kinetic energy in each layer, without that of a contact mass",
}
"""Long names of the energies in a dataset."""
