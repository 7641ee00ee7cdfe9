"""The table [contact] of a scenario: a grid along the contact, and numbers that define profiles of the quantities along it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.planar.nodes import full_names, varying
from stickslip.extensions.planar.slab import COUNTS, PlanarSlab
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import Number, OptionalNumber
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, check_fields, declare, fields_of
from stickslip.problem import Problem

LOCKED = "locked"
"""Name of the profile that is true where the contact never slips."""
PRESSED = ("body.normal_stress", "initial.load", "initial.excess")
"""Names of the quantities that scale with the normal stress."""
_DECLARED = fields_of(PlanarSlab)
GRID = (*_DECLARED, "replicas")
"""Fields that a contact shares with `PlanarSlab`."""


class PointsAlong(NamedTuple):
    """Values (SI) at places along y (m): straight lines between them, constant outside, a step where a place stands twice."""

    y: tuple[float, ...]
    values: tuple[float, ...]

    def at(self, y: Floats) -> Floats:
        """Return the values at places y (m): at a step the value behind it."""
        return np.interp(y, self.y, self.values)


@dataclass(frozen=True)
class Patch:
    """Part of a contact with values of its own: an interval of y, on a plane a box or an ellipse; or all the rest.

    `values` are those that vary (SI; true or false for `LOCKED`) by their names; y and z are intervals (m), None for everywhere.
    Over the distance `taper` (m) beyond the box, or by which both half axes of the ellipse grow, the share of the patch falls to 0.
    With `outside` the patch is everything but what the intervals describe.
    """

    values: tuple[tuple[str, float], ...]
    y: tuple[float, float] | None = None
    z: tuple[float, float] | None = None
    shape: str = "box"
    taper: float = 0.0
    outside: bool = False

    def share(self, *where: Floats) -> Floats:
        """Return the share of the patch in the values at places y, or y and z (m): from 0 to 1."""
        sides = [(place, *interval) for place, interval in zip(where, (self.y, self.z), strict=False) if interval is not None]
        middles, halves = [0.5 * (low + high) for _, low, high in sides], [0.5 * (high - low) for _, low, high in sides]
        off = [np.abs(place - middle) for (place, _, _), middle in zip(sides, middles, strict=True)]
        if self.shape == "ellipse":
            inner = np.sqrt(sum((one / half) ** 2 for one, half in zip(off, halves, strict=True)))
            outer = np.sqrt(sum((one / (half + self.taper)) ** 2 for one, half in zip(off, halves, strict=True)))
            with np.errstate(divide="ignore", invalid="ignore"):  # along a ray, inside 1, and 0 at the outer ellipse
                found = np.where(inner <= 1.0, 1.0, inner * (1.0 - outer) / (inner - outer) if self.taper else 0.0)
        else:
            beyond = np.sqrt(sum(np.maximum(one - half, 0.0) ** 2 for one, half in zip(off, halves, strict=True)))
            found = 1.0 - beyond / self.taper if self.taper else np.where(beyond > 0.0, 0.0, 1.0)
        found = np.clip(found, 0.0, 1.0)
        return np.asarray(1.0 - found if self.outside else found, float)


Profile = PointsAlong | tuple[Any, ...]
"""What varies: points along y, or values at the nodes: (nodes,) numbers, on a plane (nodes,) tuples of (width_nodes,) numbers."""


@dataclass(frozen=True)
class Contact:
    """A grid along the contact of a slab, with the fields of `stickslip.PlanarSlab`, and what varies along it.

    A run keeps so many `frames` of each two-way travel time; None stands for the default of `stickslip.simulate`. `along` has a
    profile for the name of the number that varies. Later `patches` are on top of earlier ones and of `along`.
    """

    nodes: int = declare(*_DECLARED["nodes"])
    length: Number = declare(*_DECLARED["length"])
    width: OptionalNumber = declare(*_DECLARED["width"])
    width_nodes: int | None = declare(*_DECLARED["width_nodes"])
    replicas: bool = True
    courant: Number = declare(*_DECLARED["courant"])
    frames: int | None = declare(Quantity("1", "frames kept of each two-way travel time", at_least=1), None)
    along: tuple[tuple[str, Profile], ...] = ()
    patches: tuple[Patch, ...] = ()

    def __post_init__(self) -> None:
        check_fields(self)
        for name in (*COUNTS, "frames"):
            count = getattr(self, name)
            if count is not None and not float(count).is_integer():
                raise InputError(f"Contact: {name} must be a whole number, got {count:g}")
            object.__setattr__(self, name, None if count is None else int(count))

    def __repr__(self) -> str:
        nodes = f"{self.nodes}" + (f" x {self.width_nodes}" if self.width_nodes else "")
        names = [name for name, _ in self.along] + [f"{len(self.patches)} patches"] * bool(self.patches)
        return f"Contact({', '.join([f'{nodes} nodes', *names])})"

    @classmethod
    def of(cls, slab: PlanarSlab, frames: int | None = None) -> Self:
        """Return the contact of a planar slab, with all that varies as values at the nodes."""
        names = full_names(slab.problem, slab.along, "Contact")
        along = [(names[name], _tuples(slab.at_nodes(name, given))) for name, given in slab.along.items()]
        if slab.locked.any():
            along.append((LOCKED, _tuples(slab.locked)))
        return cls(**{name: getattr(slab, name) for name in GRID}, frames=frames, along=tuple(along))

    @property
    def names(self) -> set[str]:
        """The names of all that varies."""
        return {name for name, _ in self.along} | {name for patch in self.patches for name, _ in patch.values}

    def pressed(self, factor: float) -> Self:
        """Return a contact on which normal stress and initial load are `factor` times what is given along it."""

        def scaled(given: Any) -> Any:
            if isinstance(given, tuple):
                return given._replace(values=scaled(given.values)) if isinstance(given, PointsAlong) else tuple(map(scaled, given))
            return factor * given

        along = tuple((name, scaled(one) if name in PRESSED else one) for name, one in self.along)
        patches = [
            replace(patch, values=tuple((name, scaled(one) if name in PRESSED else one) for name, one in patch.values))
            for patch in self.patches
        ]
        return replace(self, along=along, patches=tuple(patches))

    def slab(self, problem: Problem) -> PlanarSlab:
        """Return the planar slab with this contact. Raises InputError as `PlanarSlab` does, and for a patch that has no node."""
        for given, other in (("initial.load", "initial.excess"), ("initial.excess", "initial.load")):
            if given in self.names and getattr(problem, given.replace(".", "_")) is None:
                raise InputError(f"Contact: {given} varies, but [initial] gives {other[8:]}: give the same of them in both")
        grid = {name: getattr(self, name) for name in GRID}
        along = {name: partial(self.at, name, varying(problem)[name][1]) for name in sorted(self.names - {LOCKED})}
        return PlanarSlab(problem, **grid, along=along, barrier=partial(self.at, LOCKED, False) if LOCKED in self.names else None)

    def at(self, name: str, elsewhere: float, *where: Floats) -> NDArray[Any]:
        """Return what varies at places y, or y and z (m), of all nodes; `elsewhere` is its value (SI) where nothing is given."""
        given, shape = dict(self.along).get(name, elsewhere), np.shape(where[0])
        if isinstance(given, PointsAlong):
            found = given.at(where[0])
        elif isinstance(given, tuple):
            found = _array(name, given, shape)
        else:
            found = np.full(shape, given, float)
        for i, patch in enumerate(self.patches):
            share = patch.share(*where)
            if not share.any():
                ends = ", ".join(f"{axis} = {one.min():g} to {one.max():g} m" for axis, one in zip("yz", where, strict=False))
                raise InputError(f"Contact: patches[{i}] has no node: nodes lie at {ends}")
            if name in dict(patch.values):
                found = share * dict(patch.values)[name] + (1.0 - share) * found
        return found > 0.5 if name == LOCKED else found


def _tuples(values: NDArray[Any]) -> tuple[Any, ...]:
    found = values.tolist()
    return tuple(tuple(row) if isinstance(row, list) else row for row in found)


def _array(name: str, given: tuple[Any, ...], shape: tuple[int, ...]) -> Floats:
    """Return values at the nodes as an array. Raises InputError if there is not one for each node."""
    try:
        found = np.asarray(given, float)
    except ValueError:  # rows of different lengths
        found = np.empty(0)
    if found.shape != shape:
        rows = sorted({len(one) for one in given if isinstance(one, tuple)})
        got = f"{len(given)}" + (f" lists of {' or '.join(map(str, rows))}" if rows else "")
        wanted = " lists of ".join(map(str, shape))
        raise InputError(f"Contact: along.{name} must have {wanted} values, one for each node, got {got}")
    return found
