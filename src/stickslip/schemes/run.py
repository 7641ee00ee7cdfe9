"""Run a scheme on a grid."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from stickslip.bodies import as_slab
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.schemes.contact import GridContact
from stickslip.schemes.contract import Grid, Sample, Scheme
from stickslip.schemes.series import Series

LARGEST_CELLS, LARGEST_STEPS = 100_000, 2_000_000
"""Largest number of cells and of steps of a run."""
FEWEST_CELLS = 12
"""Smallest number of cells: the widest difference at two boundaries."""


def check_suitable(problem: Problem) -> None:
    """Raise InputError for a problem that the schemes do not treat."""
    slab = as_slab(problem.body, "schemes: a block has no grid")
    if slab.has_inertia:
        raise InputError(f"schemes: a contact_mass of {slab.contact_mass:g} kg/m^2 is not in the schemes: set it to 0")
    if problem.varies:
        raise InputError("schemes: a pull rate or a far stress that varies in time is not in the schemes: give constant ones")
    GridContact(problem)


def grid_of(problem: Problem, cells: int, courant: float) -> Grid:
    """Return the grid of a problem. Raises InputError if it has too few or too many cells."""
    if not FEWEST_CELLS <= cells <= LARGEST_CELLS:
        raise InputError(f"schemes: cells must lie between {FEWEST_CELLS} and {LARGEST_CELLS}, got {cells}")
    slab = as_slab(problem.body, "schemes: a block has no grid")
    far = problem.load if problem.far_stress is None else float(problem.far_stress)  # type: ignore[arg-type]
    return Grid(
        cells=cells,
        density=slab.density,
        wave_speed=slab.wave_speed,
        thickness=slab.thickness,
        driver_impedance=slab.driver_impedance,
        pull_rate=problem.first_pull_rate,
        stress=problem.load,
        far_stress=far - problem.load,
        far_stress_rate=problem.far_stress_rate,
        slip=problem.initial_slip,
        courant=courant,
    )


def _grid_and_steps(problem: Problem, duration: float, scheme: Scheme, cells: int, courant: float | None) -> tuple[Grid, int]:
    """Return the grid and the number of steps of a run. Raises InputError for numbers out of range."""
    check_suitable(problem)
    number = scheme.courant if courant is None else courant
    if not 0.0 < number <= scheme.largest_courant:
        raise InputError(f"schemes: {scheme.name}: the Courant number must lie in (0, {scheme.largest_courant:g}], got {number:g}")
    if scheme.name == "characteristics" and number != 1.0:
        raise InputError("schemes: characteristics: the Courant number is 1, because waves move by one cell in a step")
    grid = grid_of(problem, cells, number)
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
            _grid_and_steps(problem, duration, scheme, cells, courant)


def run_scheme(
    problem: Problem, duration: float, scheme: Scheme, cells: int, *, search: str = "stick-first", courant: float | None = None
) -> Series:
    """Run a scheme from t = 0 to a duration (s) or just beyond it, and return the series at the contact.

    Parameters
    ----------
    problem : Problem
        Problem with a slab without contact mass and a law without a state.
    duration : float
        Duration, s.
    scheme : Scheme
        Numerical scheme.
    cells : int
        Number of cells in the thickness.
    search : str
        How the contact looks for a root: see `stickslip.schemes.contact.SEARCHES`.
    courant : float, optional
        Courant number c dt / dx, by default the scheme's own.

    Returns
    -------
    Series
        The series at the contact, with energies.

    Raises
    ------
    InputError
        If the problem does not suit, if cells, steps or the Courant number are out of range, or if the run becomes infinite.
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
