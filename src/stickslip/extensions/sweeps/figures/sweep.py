"""Figure of a sweep: one quantity over the varied keys, as curves, a map, several maps, or points.

The dataset of a grid has one dimension for each varied key; those of samples and lists have the dimension `member`.
"""

from __future__ import annotations

import re
import tomllib
from contextlib import suppress
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import xarray as xr

from stickslip.extensions.sweeps.design.design import MEMBER
from stickslip.extensions.sweeps.execution.chunk import FIRST_FAILURE, NOT_RUN
from stickslip.extensions.sweeps.figures.curves import MOST_CURVES, draw_curves
from stickslip.extensions.sweeps.figures.maps import draw_maps, draw_members
from stickslip.figures.sheet import shown_or_saved
from stickslip.figures.style import styled
from stickslip.foundation.arguments import for_users
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.given import Units, shown_in
from stickslip.foundation.place import Place
from stickslip.problem import units_given
from stickslip.problem.scenarios import read_scenario


@for_users
def plot_sweep(dataset: xr.Dataset, quantity: str | None = None, path: str | Path | None = None, **place: Unpack[Place]) -> Any:
    """Draw a quantity of a sweep over the varied keys, and save the figure if a file is named.

    Parameters
    ----------
    dataset : xarray.Dataset
        The result of `sweep`.
    quantity : str, optional
        Name of the quantity; by default the first one of the sweep.
    path : str or Path, optional
        File to be written, either whole or not at all.
    **place
        Where to draw, and how large: `figure`, `size` and `dpi`, and `ax` for one map or one family of curves, as for
        `solution.plot`.

    Returns
    -------
    matplotlib.figure.Figure or matplotlib.axes.Axes
        The figure, or the axes if `ax` was given. One varied key gives a curve, which is interrupted where the quantity jumps; two
        give a map, or a family of curves if one of them has at most four values; three give maps side by side. Members that are not
        a grid are drawn as points.

    Raises
    ------
    InputError
        If the sweep has no such quantity, if nothing is varied, or for a grid of more than three keys: then select some values of
        the other keys first.
    """
    with shown_in(_units_of(dataset)):
        drawn = draw_sweep(sweep_data(dataset, quantity), **place)
    return shown_or_saved(drawn, path, place)


def _units_of(dataset: xr.Dataset) -> Units:
    """Return the units in which the scenario of a sweep was given; none for a dataset of anybody without a scenario."""
    with suppress(InputError, KeyError):
        return units_given(read_scenario(dataset.attrs["scenario"], "plot_sweep").problem)
    return {}


def sweep_data(dataset: xr.Dataset, quantity: str | None = None) -> xr.Dataset:
    """Return the dataset that is drawn: the quantity (NaN without a number), its `state` and the varied keys.

    The state of a member is 0 if it has a number, 1 if its run has no such number, 2 if it failed, 3 if it was not run. Keys with a
    single value are dropped as dimensions. Raises InputError as `plot_sweep` does.
    """
    names = [str(name) for name in dataset.data_vars if _can_be_drawn(dataset, str(name))]
    name = quantity or next(iter(names), "")
    if name not in names:
        raise InputError(f"plot_sweep: this sweep has no quantity {ascii(name)[:60]}; {nearest(name, names)}")
    values = dataset[name].load()
    status = dataset["status"].transpose(*values.dims)
    kinds = [status.values >= FIRST_FAILURE, status.values == NOT_RUN, np.isnan(values.values)]
    state = xr.Variable(values.dims, np.select(kinds, [2, 3, 1], 0))
    drawn = dataset[[name, "status"]].assign({name: values.where(state == 0), "state": state}).squeeze(drop=False)
    if len(drawn[name].dims) > 3:
        raise InputError(f"plot_sweep: a grid of {len(drawn[name].dims)} keys: select some values first, dataset.sel(KEY=VALUE)")
    if not drawn[name].dims:
        raise InputError("plot_sweep: nothing is varied in this sweep, it has one member")
    return drawn.assign_attrs(dataset.attrs, quantity=name, title=_title(dataset))


def _title(dataset: xr.Dataset) -> str:
    """Return the title of the scenario, "" if it has none, without phrases that give a number to what is varied here."""
    title = str(tomllib.loads(dataset.attrs.get("scenario", "")).get("title", ""))
    varied = {str(name).rsplit(".", 1)[-1] for name in dataset.coords}
    return ", ".join(part for part in title.split(", ") if not any(re.search(rf"\b{name}\b *=", part) for name in varied))


def _can_be_drawn(dataset: xr.Dataset, name: str) -> bool:
    values = dataset[name]
    numbers = bool(np.issubdtype(values.dtype, np.number))
    return numbers and name != "status" and values.dims == dataset["status"].dims


@styled
def draw_sweep(dataset: xr.Dataset, **place: Unpack[Place]) -> Any:
    """Draw the kind of figure that suits the members."""
    shape = dataset["state"].shape
    if MEMBER in dataset["state"].dims:
        return draw_members(dataset, **place)
    curves = len(shape) == 1 or (len(shape) == 2 and min(shape) <= MOST_CURVES)
    return draw_curves(dataset, **place) if curves else draw_maps(dataset, **place)
