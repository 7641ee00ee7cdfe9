"""List the numerical schemes, and run one on a grid, with the friction of a problem at its contact node.

If friction falls fast enough with the slip rate, several slip rates solve the contact equation `impedance v + S mu(u, v) = load` of
a step. A program then takes one of them, by its way of searching. `SEARCHES` has the usual ways.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy.optimize import brentq

from stickslip.extensions.schemes.contract import Grid, Meeting, Met, Sample, Scheme, Series
from stickslip.extensions.schemes.explicit import CentralDifferences, Characteristics, MassRedistribution, Regularised
from stickslip.extensions.schemes.implicit import Newmark, Theta
from stickslip.extensions.schemes.sbp import SummationByParts
from stickslip.foundation.arguments import check_whole
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.friction import FrictionLaw
from stickslip.problem import Problem, driver_of, features
from stickslip.problem.bodies import ElasticSlab, as_slab

_ALL: tuple[Scheme, ...] = (
    Characteristics(),
    CentralDifferences("central-differences", "central differences, lumped mass", 0.8),
    CentralDifferences("central-differences-cfl1", "central differences, lumped mass, Courant number 1", 1.0),
    MassRedistribution(),
    Newmark("newmark", "finite elements, Newmark, constant mean acceleration", 0.0),
    Newmark("hht", "finite elements, HHT-alpha, alpha = 0.1", 0.1),
    Theta("theta", "finite elements, theta = 0.6", 0.6),
    Theta("backward-euler", "finite elements, backward Euler", 1.0),
    SummationByParts(2),
    SummationByParts(4),
    SummationByParts(6),
    Regularised(),
)
SCHEMES: dict[str, Scheme] = {scheme.name: scheme for scheme in _ALL}
"""The schemes by name."""


# ---- the contact and the run --------------------------------------------------------------------------------------------

SEARCHES = {
    "stick-first": "stick wherever the static strength holds, otherwise the smallest root",
    "continue": "the root next to the slip rate of the step before, in the direction in which the equation is violated",
    "newton": "Newton's method from the slip rate of the step before, without safeguards; stick if it leaves slip",
    "fastest": "the largest root",
}
"""Ways to search for a root, each with its meaning."""
SEARCH_RATES = 48
"""Number of slip rates, in each of two sets, in the search for roots."""
ROUNDING_OF_LOAD = 16.0 * float(np.finfo(float).eps)
"""A load that exceeds the strength by less than this share of it does not begin slip."""
NEWTON_STEPS = 50
"""Largest number of Newton's steps."""
Missing = Callable[[Floats], Floats]


class GridContact:
    """The friction of a problem, for one run of a scheme; `search`, one of SEARCHES, says how a root is looked for.

    Friction that is regularised by `smoothing`, a slip rate v0 (m/s), is mu tanh(v/v0) and never sticks; 0 stands for friction with
    stick. Raises InputError if the search is unknown, or the law has a state or remembers slip since the last arrest only, and
    if the contact starts in motion.
    """

    def __init__(self, problem: Problem, search: str = "stick-first", smoothing: float = 0.0) -> None:
        law = problem.friction
        if search not in SEARCHES:
            raise InputError(f"schemes: there is no search {ascii(search)[:60]}; {nearest(search, SEARCHES)}")
        if law.states or law.memory == "since-arrest" or not law.sticks:
            raise InputError(
                f"schemes: {law.kind} friction remembers more than slip, or never sticks: the schemes have no such contact"
            )
        if problem.has_initial_rate:
            raise InputError("schemes: the schemes start from rest: leave out initial_rate")
        self.law, self.normal, self.search, self.smoothing = law, problem.normal, search, smoothing
        self._path = law.counts == "path"
        self._law_slip, self._slip = problem.law_slip, problem.initial_slip
        self._bottom = float(law.range()[0])
        self._yields = problem.excess == 0.0 and (problem.first_pull_rate > 0.0 or _far_rate(problem) > 0.0)

    def meet(self, meeting: Meeting, before: float) -> Met:
        """Solve the contact equation of a step; `before` is the slip rate (m/s) of the step before."""
        way = 1.0 if meeting.load >= 0.0 else -1.0
        strength = self.normal * float(self._law(way).static_coefficient(self._seen(meeting.slip)))
        margin = (
            -ROUNDING_OF_LOAD if self._yields else ROUNDING_OF_LOAD
        )  # a load at the strength that is about to rise begins slip at once
        holds = abs(meeting.load) <= strength * (1.0 + margin) and not self.smoothing
        self._yields = False
        rate = way * self._root(meeting, way, max(way * before, 0.0), holds)
        slip = meeting.slip + meeting.slip_per_rate * rate
        self._law_slip, self._slip = self._seen(slip), slip
        return Met(rate, meeting.load - meeting.impedance * rate)

    def _law(self, way: float) -> FrictionLaw:
        """Return the law that slip in a direction sees, forwards (1) or backwards (-1)."""
        found: FrictionLaw = self.law.ways[way < 0.0]
        return found

    def _seen(self, slip: Any) -> Any:
        """Return the slip that the law sees (m): the path so far, if it counts the path."""
        return self._law_slip + abs(slip - self._slip) if self._path else slip

    def _root(self, meeting: Meeting, way: float, before: float, holds: bool) -> float:
        """Return the magnitude of the slip rate, m/s."""
        load, law = abs(meeting.load), self._law(way)

        def missing(rate: Floats) -> Floats:
            seen = self._seen(meeting.slip + way * meeting.slip_per_rate * rate)
            friction = self.normal * law.coefficient(seen, rate)
            if self.smoothing:
                friction = friction * np.tanh(rate / self.smoothing)
            return meeting.impedance * rate + friction - load

        if holds and (self.search == "stick-first" or (before == 0.0 and self.search != "fastest")):
            return 0.0
        if not (self.law.depends_on_rate or meeting.slip_per_rate or self.smoothing):
            return max(-float(missing(np.zeros(()))) / meeting.impedance, 0.0)
        if self.search == "newton":
            found = _newton(missing, before, meeting.impedance)
            if found is not None and (found > 0.0 or holds):
                return found
        top = max(2.0 * (load - self.normal * min(self._bottom, 0.0)) / meeting.impedance, 2.0 * before, 1e-300)
        return _scan(missing, 0.0 if self.search == "stick-first" else before, top, self.search)


def _scan(missing: Missing, start: float, top: float, search: str) -> float:
    """Return the root that a search finds between 0 and `top` (m/s), where more is resisted than loads; 0 if it finds none."""
    rates = np.unique(np.concatenate([[start], np.linspace(0.0, top, SEARCH_RATES), np.geomspace(1e-12 * top, top, SEARCH_RATES)]))
    below = missing(rates) < 0.0
    rising, falling = np.flatnonzero(below[:-1] & ~below[1:]), np.flatnonzero(~below[:-1] & below[1:])
    place = int(np.searchsorted(rates, start))
    if search == "fastest":
        chosen = rising[-1:]
    elif below[place] or start == 0.0:
        chosen = rising[rising >= place][:1]
    else:  # slip is too fast: the root below, unless the resistance exceeds the load all the way down
        chosen = rising[rising < place][-1:]
        if falling.size and chosen.size and not below[0]:
            chosen = chosen if falling[falling < place].size else chosen[:0]
    if not chosen.size:
        return 0.0
    k = int(chosen[0])
    return float(brentq(lambda rate: float(missing(np.asarray(rate))), rates[k], rates[k + 1], xtol=1e-300, rtol=1e-14))


def _newton(missing: Missing, start: float, impedance: float) -> float | None:
    """Return the root of Newton's method from a slip rate (m/s): 0 if it leaves slip, None if it does not converge."""
    rate = start
    for _ in range(NEWTON_STEPS):
        width = 1e-7 * max(rate, 1e-9)
        value, above = missing(np.array([rate, rate + width])).tolist()
        slope = (above - value) / width
        step = -value / (slope or impedance)
        rate += step
        if rate <= 0.0:
            return 0.0
        if abs(step) <= 1e-10 * rate:
            return float(rate)
    return None


LARGEST_CELLS, LARGEST_STEPS = 100_000, 2_000_000
"""Largest number of cells and of steps of a run."""
FEWEST_CELLS = 12
"""Smallest number of cells: the widest difference at two boundaries."""


def _slab_of(problem: Problem) -> ElasticSlab:
    """Return the slab of a problem. Raises InputError for any other body."""
    return as_slab(problem.body, f"schemes: {type(problem.body).__name__} has no grid: they are of an ElasticSlab")


def check_suitable(problem: Problem) -> None:
    """Raise InputError for a problem that the schemes do not treat."""
    slab = _slab_of(problem)
    if slab.has_inertia:
        raise InputError(f"schemes: a contact_mass of {slab.contact_mass:g} kg/m^2 is not in the schemes: set it to 0")
    missing = "is not in the schemes"
    first = features.DASHPOT, features.DRIVEN_BY_MACHINE, features.DRIVER_THAT_CHANGES
    features.refuse("schemes", problem, dict.fromkeys(first, missing))
    if problem.varies:
        raise InputError(
            "schemes: a pull rate, far stress or normal load that varies in time is not in the schemes: give constant ones"
            + ", and ground at rest" * (problem.ground is not None)
        )
    features.refuse("schemes", problem, {features.ONE_WAY: missing})
    GridContact(problem)


def _far_rate(problem: Problem) -> float:
    """Return the rate of change of the far stress (Pa/s), as far as it is felt."""
    return 0.0 if "far_stress_rate" in driver_of(problem).unfelt else problem.far_stress_rate


def grid_of(problem: Problem, duration: float, cells: int, courant: float) -> Grid:
    """Return the grid of a run of some duration (s). Raises InputError if it has too few or too many cells."""
    check_whole("schemes: cells", cells, FEWEST_CELLS, LARGEST_CELLS)
    slab = _slab_of(problem)
    given = None if "far_stress" in driver_of(problem).unfelt else problem.far_stress
    far = problem.load if given is None else float(given)  # type: ignore[arg-type] # constant here
    return Grid(
        cells=cells,
        density=slab.density,
        wave_speed=slab.wave_speed,
        thickness=slab.thickness,
        driver_impedance=slab.driver_impedance,
        pull_rate=problem.first_pull_rate,
        stress=problem.load,
        far_stress=far - problem.load,
        far_stress_rate=_far_rate(problem),
        slip=problem.initial_slip,
        courant=courant,
        problem=problem,
        duration=duration,
    )


def _grid_and_steps(problem: Problem, duration: float, scheme: Scheme, cells: int, courant: float | None) -> tuple[Grid, int]:
    """Return the grid and the number of steps of a run. Raises InputError for numbers out of range."""
    check_suitable(problem)
    number = scheme.courant if courant is None else courant
    if not 0.0 < number <= scheme.largest_courant:
        raise InputError(f"schemes: {scheme.name}: the Courant number must lie in (0, {scheme.largest_courant:g}], got {number:g}")
    if scheme.name == "characteristics" and number != 1.0:
        raise InputError("schemes: characteristics: the Courant number is 1, because waves move by one cell in a step")
    grid = grid_of(problem, duration, cells, number)
    steps = math.ceil(duration / grid.dt * (1.0 - 1e-12))
    if steps > LARGEST_STEPS:
        raise InputError(
            f"schemes: {steps} steps of {grid.dt:g} s are more than {LARGEST_STEPS}: shorten the run or coarsen the grid"
        )
    return grid, steps


def check_runs(
    problem: Problem,
    duration: float,
    schemes: Sequence[Scheme],
    meshes: Sequence[int],
    *,
    search: str = "stick-first",
    courant: float | None = None,
) -> None:
    """Raise InputError for what `run_scheme` would refuse before its first step, on any of the schemes and meshes."""
    check_suitable(problem)
    GridContact(problem, search)
    for scheme in schemes:
        for cells in meshes:
            grid, _ = _grid_and_steps(problem, duration, scheme, cells, courant)
            scheme.begin(grid)


def run_scheme(
    problem: Problem, duration: float, scheme: Scheme, cells: int, *, search: str = "stick-first", courant: float | None = None
) -> Series:
    """Run a scheme from t = 0 to a duration (s) or just beyond it, and return the series at the contact, with energies.

    The slab has so many `cells` in its thickness and no contact mass, and the law has no state. `search`, one of SEARCHES, says how
    the contact looks for a root; the Courant number c dt / dx is by default the scheme's own. Raises InputError if the problem does
    not suit, if cells, steps or the Courant number are out of range, or if the run becomes infinite.
    """
    grid, steps = _grid_and_steps(problem, duration, scheme, cells, courant)
    smoothing = getattr(scheme, "smoothing", 0.0) * problem.normal * problem.friction.variation / grid.impedance
    contact, motion = GridContact(problem, search, smoothing), scheme.begin(grid)
    samples: list[Sample] = [motion.first(contact)]
    for _ in range(steps):
        samples.append(motion.advance(contact))
        if not math.isfinite(samples[-1].slip + samples[-1].rate + samples[-1].traction):
            raise InputError(f"schemes: {scheme.name} with {cells} cells: not finite after {len(samples) - 1} steps")
    time, slip, rate, traction = np.array([sample[:4] for sample in samples], float).T
    counted = [sample.energies for sample in samples if sample.energies is not None]
    energies = np.array(counted, float) if len(counted) == len(samples) else None
    return Series(time, slip, rate, traction, scheme.name, cells, energies)
