"""Read the table [contact] of a scenario into a `Contact`, and write it back."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from stickslip.extensions.planar.contact import GRID, LOCKED, Contact, Patch, PointsAlong, Profile
from stickslip.extensions.planar.nodes import varying
from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.quantities import LARGEST_SERIES, Choice, Quantity
from stickslip.problem import Problem
from stickslip.problem.scenarios import without_owner

INTERVALS_OF_AXES = {axis: Quantity("m", f"interval of {axis}, 0 in the middle of the contact") for axis in ("y", "z")}
SHAPE = Choice("shape of a patch on a plane", ("box", "ellipse"))
TAPER = Quantity("m", "distance beyond the patch in which its values pass to those beneath, linearly", at_least=0)
PATCH: dict[str, Any] = {"y": None, "z": None, "shape": "box", "taper": 0.0, "outside": False}
"""The keys of a patch beside what varies, with their defaults."""
OF_POINTS = ("y", "values")
"""The keys of a profile that is linear between points."""


def read_contact(table: Mapping[str, Any], problem: Problem, file: str) -> Contact:
    """Return the contact that a table [contact], whose keys are checked, describes for a problem. Raises InputError."""
    reader = _ContactReader(file, {name: declared for name, (declared, _) in varying(problem).items()} | {LOCKED: None})
    grid = {name: value for name, value in table.items() if name not in ("along", "patches")}
    along, is_plane = reader.names(table["along"], "[contact.along]", {}), table["width"] is not None
    patches = [reader.patch(one, f"[contact.patches[{i}]]", is_plane) for i, one in enumerate(table["patches"])]
    profiles = tuple((name, reader.profile(name, value, place)) for name, value, place in along)
    try:
        return Contact(**grid, along=profiles, patches=tuple(patches))
    except InputError as error:
        raise InputError(f"{file}: [contact] {without_owner(error)}") from None


@dataclass(frozen=True)
class _ContactReader:
    """The name of the file for messages, and what may vary: each name with its declaration, None for what is true or false."""

    file: str
    varying: Mapping[str, Quantity | None]

    def fault(self, text: str) -> InputError:
        return InputError(f"{self.file}: {text}")

    def names(self, raw: Mapping[str, Any], table: str, own: Mapping[str, Any]) -> list[tuple[str, Any, str]]:
        """Return full name, value and place of all entries of a table: "initial.load" may be one, or one in its table initial."""
        found: dict[str, tuple[str, Any, str]] = {}
        for short, value in _flat(raw):
            place = f"{table} {short}"
            known = [*own, *self.varying]
            name = full_name(short, known, f"{self.file}: {table} ", "is not a number that can vary along the contact")
            if name in found:
                raise self.fault(f"{place} is given twice")
            found[name] = name, value, place
        return list(found.values())

    def profile(self, name: str, value: Any, place: str) -> Profile:
        """Return values at the nodes, or at points along y."""
        wanted = "a list with a value for each node" + (", or a table of y and values" if self.varying[name] else "")
        if isinstance(value, list):
            return tuple(self.value(name, one, f"{place}[{i}]") for i, one in enumerate(value))
        if not isinstance(value, dict) or set(value) != set(OF_POINTS) or not self.varying[name]:
            raise self.fault(f"{place} must be {wanted}, got {shown(value)}")
        y, values = (value[key] for key in OF_POINTS)
        if not (isinstance(y, list) and isinstance(values, list) and 2 <= len(y) == len(values) <= LARGEST_SERIES):
            raise self.fault(f"{place} must have a list y and a list of as many values, 2 to {LARGEST_SERIES}")
        y = tuple(INTERVALS_OF_AXES["y"].check(self.file, f"{place}.y[{i}]", one) for i, one in enumerate(y))
        if any(one > following for one, following in pairwise(y)) or any(y[i] == y[i + 2] for i in range(len(y) - 2)):
            raise self.fault(f"{place}.y must ascend, where a step is the same place twice")
        return PointsAlong(y, tuple(self.value(name, one, f"{place}.values[{i}]") for i, one in enumerate(values)))

    def value(self, name: str, value: Any, place: str, depth: int = 0) -> Any:
        """Return a value in SI; a list of them, the nodes along z, as a tuple."""
        declared = self.varying[name]
        if isinstance(value, list) and depth == 0:
            return tuple(self.value(name, one, f"{place}[{i}]", 1) for i, one in enumerate(value))
        if declared is not None:
            return declared.check(self.file, place, value)
        if not isinstance(value, bool):
            raise self.fault(f"{place} must be true or false, got {shown(value)}")
        return value

    def patch(self, raw: Any, table: str, is_plane: bool) -> Patch:
        """Return a patch."""
        if not isinstance(raw, dict):
            raise self.fault(f"{table} must be a table, got {shown(raw)}")
        found = self.names(raw, table, PATCH)
        own = PATCH | {name: value for name, value, _ in found if name in PATCH}
        own |= {axis: self.interval(own[axis], axis, f"{table} {axis}") for axis in INTERVALS_OF_AXES if own[axis] is not None}
        own["shape"] = SHAPE.check(self.file, f"{table} shape", own["shape"])
        own["taper"] = TAPER.check(self.file, f"{table} taper", own["taper"])
        values = tuple((name, self.value(name, value, place, 1)) for name, value, place in found if name not in PATCH)
        for broken, rule in (
            (not isinstance(own["outside"], bool), f"outside must be true or false, got {shown(own['outside'])}"),
            (own["y"] is None and own["z"] is None, 'needs y, an interval such as ["-4 km", "4 km"]' + ", or z" * is_plane),
            (own["z"] is not None and not is_plane, "z is for a plane, a contact with width and width_nodes"),
            (own["shape"] == "ellipse" and None in (own["y"], own["z"]), "an ellipse needs y and z, on a plane"),
            (not values, 'says nothing: give locked = true, or a number such as initial.load = "71 MPa"'),
            (own["taper"] > 0.0 and LOCKED in dict(values), "a locked patch has no taper: take two patches"),
        ):
            if broken:
                raise self.fault(f"{table} {rule}")
        return Patch(values, **own)

    def interval(self, value: Any, axis: str, place: str) -> tuple[float, float]:
        """Return an interval (m)."""
        if not isinstance(value, list) or len(value) != 2:
            raise self.fault(f'{place} must be an interval such as ["-4 km", "4 km"], got {shown(value)}')
        low, high = (INTERVALS_OF_AXES[axis].check(self.file, f"{place}[{i}]", one) for i, one in enumerate(value))
        if low >= high:
            raise self.fault(f"{place} must go from the smaller to the larger end, got {shown(value)}")
        return low, high


def _flat(table: Mapping[str, Any], before: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in table.items():
        if isinstance(value, dict) and not set(OF_POINTS) & set(value):
            yield from _flat(value, f"{before}{name}.")
        else:
            yield f"{before}{name}", value


def contact_table(contact: Contact) -> dict[str, Any]:
    """Return a contact as the table [contact], in SI and to the last digit."""
    table = {name: getattr(contact, name) for name in (*GRID, "frames") if getattr(contact, name) is not None}
    along = {name: given._asdict() if isinstance(given, PointsAlong) else given for name, given in contact.along}
    patches = []
    for patch in contact.patches:
        own = {name: getattr(patch, name) for name, default in PATCH.items() if getattr(patch, name) != default}
        patches.append(own | dict(patch.values))
    return table | ({"along": along} if along else {}) | ({"patches": patches} if patches else {})
