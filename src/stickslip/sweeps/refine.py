"""Refine a map where an answer changes: a coarse sweep, then ever smaller cells along the boundary
(`stickslip.sweeps.design.adaptive_grid`).

Each round of the search is a sweep over a list of members, kept like any other: a search that was killed finds its rounds done.
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

from stickslip.foundation.errors import InputError
from stickslip.scenarios.scenario import Scenario, load_scenario
from stickslip.sweeps.design.adaptive_grid import MOST_MEMBERS, Floats, Integers, refine_cells
from stickslip.sweeps.design.design import MEMBER, Design, axes_of
from stickslip.sweeps.design.parameter_paths import Key
from stickslip.sweeps.design.quantities import DEFAULT, Summary, Wanted, quantities_named
from stickslip.sweeps.execution.outcome import FIRST_FAILURE, NOT_RUN
from stickslip.sweeps.execution.plan import Plan, make_plan
from stickslip.sweeps.results.layout import REASON, STATUS, attributes
from stickslip.sweeps.results.refinement_spec import ATTRIBUTE, Recipe
from stickslip.sweeps.results.store import open_store, publish, writing
from stickslip.sweeps.sweep import Progress, Runner, carry_out, check_out, runner_of

DEPTH = 6
LEVEL = "level"
COMPLETE = "refinement_complete"
"""Attribute: 1 where the search came to its end, 0 where it was stopped or ran into the most members that were allowed."""


class _StoppedError(Exception):
    """Ctrl-C."""


def refine(
    scenario: Scenario | str,
    vary: Any,
    quantity: str,
    *,
    depth: int = DEPTH,
    factor: float | None = None,
    most: int = MOST_MEMBERS,
    quantities: Iterable[Wanted] = DEFAULT,
    out: str | Path | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    chunk: int | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Run a coarse grid, then halve its cells `depth` times wherever a quantity differs around them.

    The grid is that of `stickslip.sweep`: its axes are numbers in ascending order. A boundary that the coarse grid has seen is
    followed to its ends, to 1/2^depth of the coarse steps. The quantity must be a whole number, unless a factor is given: then
    cells are halved around which it differs by more than that factor. Members that failed, or have no such number, say nothing.
    Ends early rather than run more than `most` members.

    Returns the members, in the order in which they were run, along the dimension `member`, with their `level` (0: coarse grid) and
    the attribute `refinement_complete` (0 where it ended early); `stickslip.sweeps.results.refinement_spec.cells_of` finds the
    cells in it again; all else is as for `stickslip.sweep`, also what goes on after a kill. Raises InputError like it.
    """
    chosen = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    axes, kept = axes_of(chosen, vary, "refine: vary"), _with(quantities, quantity)
    recipe = Recipe.of(quantity, axes, [one.name for one in kept], depth, factor, most)
    keys = tuple(axis.key for axis in axes)
    search = _Search(recipe, keys, lambda design: make_plan(chosen, design, quantities=kept, chunk=chunk))
    place = None if out is None else check_out(Path(out), "refine: out")
    if place is not None and place.exists():
        found = search.there(place)
        shutil.rmtree(_rounds_of(place), ignore_errors=True)  # of a search that was killed in its last moment
        return found
    with runner_of(threads, workers, scheduler) as (run, _):
        return search.carried_out(place, run, progress)


def _with(quantities: Iterable[Wanted], name: str) -> tuple[Summary, ...]:
    """The quantities, and the one that is searched for."""
    kept = quantities_named(quantities)
    return kept if name in {one.name for one in kept} else (*kept, *quantities_named(name))


@dataclass
class _Search:
    """Rounds of members, each a sweep of its own."""

    recipe: Recipe
    keys: tuple[Key, ...]
    plan: Callable[[Design], Plan]
    rounds: list[xr.Dataset] = field(default_factory=list)

    def carried_out(self, place: Path | None, run: Runner, progress: Progress | None) -> xr.Dataset:
        """Every round, and their members together, at `place` when all are there."""
        folder = None if place is None else _made(_rounds_of(place))

        def evaluate(points: Integers) -> Floats:
            return self.round(points, None if folder is None else folder / f"{len(self.rounds):03d}.zarr", run, progress)

        try:
            complete = refine_cells(self.recipe.lattice, evaluate, self.recipe.differ, self.recipe.most).complete
        except _StoppedError:
            return self.together(complete=False)
        if place is None or folder is None:
            return self.together(complete)
        together = self.together(complete).drop_encoding()
        publish(place, lambda draft: together.to_zarr(draft, consolidated=False))
        shutil.rmtree(folder)
        return self.there(place)

    def round(self, points: Integers, out: Path | None, run: Runner, progress: Progress | None) -> Floats:
        """Run members at points, and say what the quantity is."""
        found = carry_out(self.plan(self.members(points)), out, run, self.beyond(progress))
        level = xr.Variable(MEMBER, self.recipe.lattice.levels(points), {"long_name": "how often the coarse grid was halved"})
        self.rounds.append(found.assign_coords({LEVEL: level}).load())
        if (found.status == NOT_RUN).any():
            raise _StoppedError
        return _answers(found[self.recipe.quantity], self.recipe.factor)

    def members(self, points: Integers) -> Design:
        """The members at points, as a list."""
        return Design("list", self.keys, self.recipe.values(points))

    def beyond(self, tell: Progress | None) -> Progress | None:
        """Tell of a round as of all of them up to it."""
        if tell is None:
            return None
        done = sum(one.sizes[MEMBER] for one in self.rounds)
        failed = sum(int((one.status >= FIRST_FAILURE).sum()) for one in self.rounds)
        return lambda now: tell(now._replace(done=now.done + done, failed=now.failed + failed, members=now.members + done))

    def together(self, complete: bool) -> xr.Dataset:
        """The members of all rounds."""
        return xr.concat(self.rounds, MEMBER).assign_attrs(self.attributes, **{COMPLETE: int(complete)})

    @property
    def attributes(self) -> dict[str, Any]:
        """Where the members come from."""
        lattice = self.recipe.lattice
        coarse = attributes(self.plan(self.members(lattice.grid(lattice.coarse))))
        design = json.dumps({"design": "refined", "keys": list(self.recipe.columns)})
        return coarse | {"design": design, ATTRIBUTE: str(self.recipe)}

    def there(self, place: Path) -> xr.Dataset:
        """What is kept at `place`. Raises InputError if it is of another search."""
        found = open_store(place)
        for name, ours in self.attributes.items():
            if found.attrs.get(name) != ours:
                raise InputError(f"{place}: was made with another {name}: give what it was begun with, or another name")
        return found[[*self.recipe.kept, STATUS, REASON]]


def _answers(found: xr.DataArray, factor: float | None) -> Floats:
    """The answers of a round. Raises InputError where they are no whole numbers and no factor is given."""
    values = np.asarray(found.values, float)
    known = values[np.isfinite(values)]
    if factor is None and (known != np.rint(known)).any():
        raise InputError(f"refine: {found.name} is no whole number: say by which factor it must jump")
    return values


def _rounds_of(place: Path) -> Path:
    return place.with_suffix(".rounds")


def _made(folder: Path) -> Path:
    with writing(folder):
        folder.mkdir(exist_ok=True)
    return folder
