"""Refinement of a map where an answer changes: a coarse sweep, then smaller and smaller cells along the boundary.

The cells are chosen by `stickslip.sweeps.design.adaptive_grid`. Each round of the search is a sweep over a list of members with a
store of its own, so that a search that was killed continues after the rounds that are complete.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stickslip.foundation import zarr_folder
from stickslip.foundation.arguments import for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.run.progress import told
from stickslip.scenarios.parameter_paths import ParameterPath
from stickslip.scenarios.scenario import Scenario
from stickslip.sweeps.design.adaptive_grid import MOST_MEMBERS, Integers, refine_cells
from stickslip.sweeps.design.design import LIST, MEMBER, REFINED, Design, axes_of
from stickslip.sweeps.design.quantities import DEFAULT, Wanted, quantities_named
from stickslip.sweeps.execution.chunk import FIRST_FAILURE, NOT_RUN, Runner
from stickslip.sweeps.execution.plan import Plan, make_plan, scenario_to_vary
from stickslip.sweeps.results.layout import REASON, STATUS, attributes
from stickslip.sweeps.results.refinement_spec import ATTRIBUTE, RefinementSpec
from stickslip.sweeps.results.store import open_store, publish, writing
from stickslip.sweeps.sweep import ProgressCallback, carry_out, check_out, runner_of

DEPTH = 6
"""Default number of halvings: the finest cells are 1/64 of the coarse step along each axis."""
LEVEL = "level"
"""Name of the coordinate that holds the number of halvings after which the grid contains a member."""
COMPLETE = "refinement_complete"
"""Name of the attribute that is 1 if the search was completed, 0 if it was stopped or reached the largest number of members."""


class _StoppedError(Exception):
    """The signal that a round of the search was stopped by Ctrl-C."""


@for_users
def refine(
    scenario: Problem | Scenario | str | Path,
    vary: Any,
    quantity: str,
    *,
    duration: float | str | WithUnit | None = None,
    depth: int = DEPTH,
    factor: float | None = None,
    most: int = MOST_MEMBERS,
    quantities: Iterable[Wanted] = DEFAULT,
    out: str | Path | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    chunk: int | None = None,
    progress: ProgressCallback | bool | None = None,
) -> xr.Dataset:
    """Run a coarse grid, then halve its cells up to `depth` times wherever a quantity differs around them.

    A boundary that the coarse grid detects is followed to its ends, with a resolution of 1/2^depth of the coarse steps.

    Parameters
    ----------
    vary : mapping
        Axes of the coarse grid, as for `stickslip.sweep`, each of two or more numbers in ascending order. Between three or more
        numbers in equal ratios (`numpy.geomspace`) steps are halved into equal ratios, otherwise into equal parts.
    quantity : str
        Name of the quantity whose changes are sought. It must be a whole number unless `factor` is given. Members that failed, or
        that have no such number (NaN), cause no refinement.
    depth : int
        Number of halvings.
    factor : float, optional
        If given (above 1), halve the cells around which the quantity differs by more than this factor, or in sign.
    most : int
        Largest number of members. The search ends early rather than exceed it.
    scenario, duration, quantities, out, threads, workers, scheduler, chunk, progress
        As for `stickslip.sweep`. Until the store `out` (.zarr) is complete, the rounds are kept beside it in a folder of the same
        name with the suffix .rounds. If a search was stopped or killed, the same call continues it.

    Returns
    -------
    xarray.Dataset
        The members in the order in which they were run, along the dimension `member`, with their `level` (0 for the coarse grid).
        The attribute `refinement_complete` is 0 if the search ended early.
        `stickslip.sweeps.results.refinement_spec.cells_of` reconstructs the cells from this dataset.

    Raises
    ------
    InputError
        For anything that cannot be used, as for `stickslip.sweep`.
    """
    chosen = scenario_to_vary(scenario, duration)
    axes, kept = axes_of(chosen, vary, "refine: vary"), quantities_named(quantities)
    if quantity not in {one.name for one in kept}:
        kept = (*kept, *quantities_named(quantity))
    spec = RefinementSpec.of(quantity, axes, [one.name for one in kept], depth=depth, factor=factor, most=most)
    parameters = tuple(axis.parameter for axis in axes)
    search = _Search(spec, parameters, lambda design: make_plan(chosen, design, quantities=kept, chunk=chunk))
    place = None if out is None else check_out(Path(out), "refine: out")
    if place is not None and place.exists():
        found = search.there(place)
        shutil.rmtree(_rounds_of(place), ignore_errors=True)  # left by a search that was killed after the store was complete
        return found
    with runner_of(threads, workers, scheduler) as (run, _), told(progress, "refine") as tell:
        return search.carried_out(place, run, tell)


@dataclass
class _Search:
    """A search in rounds, each of which is a sweep over a list of members."""

    spec: RefinementSpec
    parameters: tuple[ParameterPath, ...]
    plan: Callable[[Design], Plan]
    rounds: list[xr.Dataset] = field(default_factory=list)

    def carried_out(self, place: Path | None, run: Runner, progress: ProgressCallback | None) -> xr.Dataset:
        """Run every round and return their members together. When all rounds are done, store them at `place`, if there is one."""
        folder = None if place is None else _rounds_of(place)
        if folder is not None:
            with writing(folder):
                folder.mkdir(exist_ok=True)

        def evaluate(points: Integers) -> Floats:
            return self.round(points, None if folder is None else folder / f"{len(self.rounds):03d}.zarr", run, progress)

        try:
            complete = refine_cells(self.spec.lattice, evaluate, self.spec.factor, self.spec.most).complete
        except _StoppedError:
            return self.together(complete=False)
        if place is None or folder is None:
            return self.together(complete)
        together = self.together(complete).drop_encoding()
        packed = {str(name): {"compressors": zarr_folder.COMPRESSED} for name in together.variables}
        publish(place, lambda draft: together.to_zarr(draft, consolidated=False, encoding=packed))
        shutil.rmtree(folder)
        return self.there(place)

    def round(self, points: Integers, out: Path | None, run: Runner, progress: ProgressCallback | None) -> Floats:
        found = carry_out(self.plan(self.members(points)), out, run, self.beyond(progress))
        level = xr.Variable(MEMBER, self.spec.lattice.levels(points), {"long_name": "how often the coarse grid was halved"})
        self.rounds.append(found.assign_coords({LEVEL: level}).load())
        if (found.status == NOT_RUN).any():
            raise _StoppedError
        return _answers(found[self.spec.quantity], self.spec.factor)

    def members(self, points: Integers) -> Design:
        return Design(LIST, self.parameters, self.spec.values(points))

    def beyond(self, tell: ProgressCallback | None) -> ProgressCallback | None:
        """Return a progress callback that adds the members of all earlier rounds to the counts of the present round."""
        if tell is None:
            return None
        done = sum(one.sizes[MEMBER] for one in self.rounds)
        failed = sum(int((one.status >= FIRST_FAILURE).sum()) for one in self.rounds)
        return lambda now: tell(now._replace(done=now.done + done, failed=now.failed + failed, members=now.members + done))

    def together(self, complete: bool) -> xr.Dataset:
        return xr.concat(self.rounds, MEMBER).assign_attrs(self.attributes, **{COMPLETE: int(complete)})

    @property
    def attributes(self) -> dict[str, Any]:
        """The attributes that record the origin of the members: as for a sweep, with the specification of the search."""
        lattice = self.spec.lattice
        coarse = attributes(self.plan(self.members(lattice.grid(lattice.coarse))))
        design = json.dumps({"design": REFINED, "keys": list(self.spec.columns)})
        return coarse | {"design": design, ATTRIBUTE: str(self.spec)}

    def there(self, place: Path) -> xr.Dataset:
        """Open the store at `place`. Raises InputError if it belongs to another search."""
        found = open_store(place)
        for name, ours in self.attributes.items():
            if found.attrs.get(name) != ours:
                raise InputError(f"{place}: was made with another {name}: use the same settings as before, or choose another name")
        return found[[*self.spec.kept, STATUS, REASON]]


def _answers(found: xr.DataArray, factor: float | None) -> Floats:
    """Return the answers of a round. Raises InputError if they are not whole numbers and no factor is given."""
    values = np.asarray(found.values, float)
    known = values[np.isfinite(values)]
    if factor is None and (known != np.rint(known)).any():
        raise InputError(f"refine: {found.name} is not a whole number: give the factor by which it must change")
    return values


def _rounds_of(place: Path) -> Path:
    return place.with_suffix(".rounds")
