"""The answer to a setting: all that the panels show of one run and of a record behind it, as plain arrays in SI units."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import Scenario
from stickslip.solution import Solution

if TYPE_CHECKING:
    from stickslip.extensions.inference import BesideRun

CurveName = Literal["law", "steady state", "law at the state of the start"]
"""What the curve of a friction law is, for its legend."""
MarkKind = Literal["start", "pulse", "arrest", "jump", "fold", "echo"]
DIGITS = 4
"""Number of significant digits of quantities in sentences."""


def short(value: float, unit: str) -> str:
    """Return a quantity (SI) briefly, such as "2.721 m"."""
    return brief(float(value), unit, DIGITS).replace(" um", " µm")


@dataclass(frozen=True)
class LawPicture:
    """The friction law as a curve: the friction coefficient against slip (m) or slip rate (m/s).

    `along` says against which. A law of both is drawn against slip rate at the slip of the start. `visited` is the part of the
    horizontal axis that the run passed through: its smallest and its largest value. Under a law with a state the run leaves the
    curve: `path` is where it went, an array of shape (points, 2) with (slip rate, friction coefficient), and NaN between pieces
    that a jump or, on a logarithmic axis, a time at rest separates. Of a run that reverses, slip rates and coefficients have signs.
    """

    along: Literal["slip", "slip_rate"]
    x: Floats
    coefficient: Floats
    visited: tuple[float, float]
    log: bool
    """True if the horizontal axis is better logarithmic, as for rate-and-state laws in slip that does not reverse."""
    name: CurveName = "law"
    path: Floats | None = None


@dataclass(frozen=True)
class ContactPicture:
    """The contact equation: g(v) = Z v + S mu(v) with the set K, its folds, the load line, and the path of the run on it.

    `rate` (m/s) and `load` (Pa) are the curve, `stability` is 1 on stable, -1 on unstable parts and 0 on a continuum of solutions;
    a stuck contact is at rate 0 up to `strength` (Pa). `folds` and `jumps` are pairs and quadruples of (rate, load) and
    (rate before, load before, rate after, load after). The path has NaN between pieces that a jump separates.
    """

    rate: Floats
    load: Floats
    stability: NDArray[np.int64]
    strength: float
    folds: Floats
    jumps: Floats
    path_time: Floats
    path_rate: Floats
    path_load: Floats


class StateCurve(NamedTuple):
    """One state of friction over time: what it means, its unit, and its values (SI)."""

    meaning: str
    unit: str
    values: Floats


@dataclass(frozen=True)
class BodyCurves:
    """Slip, slip rate, traction and load of one body against time (s), in the units of a body whose loads have `load_unit`.

    All arrays have one length. A shock has two points at one time, the limit from the left first.
    """

    body: Literal["slab", "block"]
    name: str
    """How the legend calls it: "slab", "block", "string", or "equivalent block"."""
    time: Floats
    slip: Floats
    slip_rate: Floats
    traction: Floats
    load: Floats
    load_unit: str
    normal_load: float = 1.0
    """Normal load of this body, in `load_unit`: traction over it can be compared between slab and block."""
    states: tuple[StateCurve, ...] = ()
    """The states of friction, at the same times."""


@dataclass(frozen=True)
class SlabPicture:
    """What happens inside the slab: arrays of shape (times, places), and the wave fronts that leave the contact.

    `time` (s since the start of the run) and `place` (m from the contact) are evenly spaced, from the first to the last shown;
    `displacement` (m, since the first of these times), `velocity` (m/s) and `stress` (Pa) are values there, the last two as means
    over the time of a cell. Each front is an array of shape (corners, 2) with (time, place). Of a run over many round trips only
    the times around its last large slip event are shown.
    """

    time: Floats
    place: Floats
    displacement: Floats
    velocity: Floats
    stress: Floats
    fronts: tuple[Floats, ...]
    boundaries: tuple[float, ...] = ()
    """Places (m) where layers meet, and the contact if there is a body on both sides of it: places there are below 0."""


@dataclass(frozen=True)
class EnergyPicture:
    """Energies against time (s): each is a curve by its name, J/m^2 for a slab and J for a block.

    The parts are elastic (above its smallest value), kinetic, heat, radiated and damped, each calculated by itself. "total" is what
    the body had at the first of these times, and the work of the driver since then: the sum of the parts, if the run balances.
    Parts that are zero throughout are left out. The times are those of the picture of the slab.
    """

    time: Floats
    parts: Mapping[str, Floats]
    unit: str


@dataclass(frozen=True)
class Mark:
    """Something that happens at one time (s), which can be clicked: a pulse, the arrest, a jump. `text` says what, in one line."""

    time: float
    kind: MarkKind
    text: str


@dataclass(frozen=True)
class KeyNumber:
    """One number for the comparison of two runs: a name, its value in SI and its unit; NaN if the run has no such number."""

    name: str
    value: float
    unit: str


@dataclass(frozen=True)
class Answer:
    """All that the explorer shows of one setting.

    `measured` is a record that is drawn behind the run, if there is one. `motions` holds the body itself first, then its companion
    of the other kind if there is one. `sentence` says regime, alpha over
    alpha_c, what jumped, and what rests on the selection rule; `regime` is "regular", "irregular" or "continuum". `notes` are
    warnings, one line each.
    """

    scenario: Scenario
    solution: Solution
    companion: Solution | None
    regime: str
    sentence: str
    law: LawPicture
    contact: ContactPicture | None
    motions: tuple[BodyCurves, ...]
    slab: SlabPicture | None
    energy: EnergyPicture
    marks: tuple[Mark, ...]
    numbers: tuple[KeyNumber, ...]
    notes: tuple[str, ...]
    measured: Measured | None = None


@dataclass(frozen=True)
class Measured:
    """Samples of a record (SI) against the time of a run, and the misfit of each measured quantity.

    `curves` are slip, slip_rate and traction (Pa, N or N m) as far as they were measured; `residuals` what is measured minus
    the run, without the zero of a sensor.
    """

    time: Floats
    curves: Mapping[str, Floats]
    misfits: tuple[KeyNumber, ...]
    name: str
    residuals: Mapping[str, Floats] = field(default_factory=dict)

    @property
    def sentence(self) -> str:
        """How far the run is from the record."""
        texts = [f"{one.name.removeprefix('misfit of ')} {short(one.value, one.unit)}" for one in self.misfits]
        return f"It differs from {self.name} by {', '.join(texts)} (root mean square)."


class RecordBehind(Protocol):
    """A record that is drawn behind all runs: a `RecordBeside` of the extension for inference."""

    def beside(self, run: Solution) -> BesideRun:
        """Return the samples beside a run, as long as it lasts."""


def measured_of(found: BesideRun) -> Measured:
    """Return what is shown of a record beside a run."""
    misfits = (KeyNumber(f"misfit of {name.replace('_', ' ')}", size, unit) for name, (size, unit) in found.misfits.items())
    return Measured(found.time, found.curves, tuple(misfits), found.name, found.residuals)
