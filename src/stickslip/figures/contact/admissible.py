"""Figure of the admissible set K of any problem: its branches by stability, the jumps of its selection rule, and a run's path."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stickslip.contact.uniqueness import Uniqueness, uniqueness_of
from stickslip.figures.contact.resistance import draw_branches
from stickslip.figures.panels import letter, panels
from stickslip.figures.style import GREEN, GREY, INK, Floats, curve_quantity, label, quantity, styled
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem

if TYPE_CHECKING:
    from stickslip.solution.solution import Solution

Height = Callable[..., Any]
"""A function that maps an excess (Pa) and the direction of slip (1 or -1) to the ordinate at which that load is drawn."""

_POINTS = 1201
"""Number of slip rates at which the curve is evaluated."""
_ROOM = 1.25
"""The curve ends at this multiple of the largest slip rate of interest, so that all folds, jumps and the run lie inside."""
_TINY = 1e-3
"""If the loads span less than this share of the static strength, they are drawn as differences from it."""


def data(problem: Problem, solution: Solution | None = None) -> xr.Dataset:
    """Return the set K for forward slip at the start of a problem, and the path of a run in it.

    Parameters
    ----------
    problem : Problem
        A slab whose slip rate follows from the load alone.
    solution : Solution, optional
        A run of the problem; its path is drawn over the set.

    Returns
    -------
    xarray.Dataset
        The curve as excess over the static strength (Pa) along `slip_rate` (m/s); `kind` (1 stable, -1 unstable, 0 continuum); the
        static strength (Pa); the jumps of the selection rule, shape (jumps, 3): slip rate before and after (m/s), excess (Pa);
        and the path of the run, slip rate (m/s) and excess (Pa), empty if no run is given.

    Raises
    ------
    InputError
        For a block, a contact mass, or a law with a state variable: the slip rate is then a state, or follows from one, and there
        is no such set.

    Notes
    -----
    If friction depends on slip, the set moves as the contact slips, and the path of the run leaves the set of the start.
    """
    contact = uniqueness_of(problem)
    g = contact.resistance
    if g is None:
        why = "the slip rate does not follow from the load alone (inertia or a state variable)"
        raise InputError(f"figure of the set K: {why}: there is no set K to draw")
    path = _path(solution, g.strength)
    ends = [rate for b in contact.branches for rate in (b.rate_from, b.rate_to) if np.isfinite(rate)]
    rates = np.union1d(np.linspace(0.0, _fastest(contact, path["path_slip_rate"].values), _POINTS), ends)
    inside = [(b.rate_from <= rates) & (rates <= b.rate_to) for b in contact.branches]
    flat = [(p.rate_from <= rates) & (rates <= p.rate_to) for p in contact.plateaus]
    kind = np.where(np.any(inside, axis=0), 1, -1)
    kind = np.where(np.any(flat, axis=0), 0, kind) if flat else kind
    jumps = np.array([(j.rate_before, j.rate_after, j.load - g.strength) for j in contact.jumps]).reshape(-1, 3)
    contents = {
        "excess": quantity("slip_rate", g.excess(rates), "load minus static strength", r"\beta - S\mu_s", "Pa"),
        "kind": xr.Variable("slip_rate", kind, {"long_name": "1 stable, -1 unstable, 0 continuum"}),
        "strength": quantity((), g.strength, "static strength", r"S\mu_s", "Pa"),
        "jump": xr.Variable(("jumps", "value"), jumps, {"long_name": "rate before (m/s), rate after (m/s), excess (Pa)"}),
    }
    place = f" at a slip of {g.law_slip:.6g} m" if problem.friction.depends_on_slip else ""
    coordinates = {"slip_rate": curve_quantity("slip_rate", rates, "slip_rate")}
    title = f"Set K: {type(problem.friction).kind} friction{place}, {contact.regime}"
    attributes = {"title": title, "rule": contact.rule}
    return xr.Dataset(contents | path, coords=coordinates, attrs=attributes)


def _path(solution: Solution | None, strength: float) -> dict[str, xr.Variable]:
    rate = load = np.zeros(0)
    if solution is not None:
        (_, rate), (_, load) = solution.curve("slip_rate"), solution.curve("load")
    return {
        "path_slip_rate": quantity("path", rate, "slip rate of the run", "v", "m/s"),
        "path_excess": quantity("path", load - strength, "load of the run minus static strength", r"\beta - S\mu_s", "Pa"),
    }


def _fastest(contact: Uniqueness, path: Floats) -> float:
    """Return the end of the axis of slip rates (m/s), beyond every fold, every jump and the run.

    If none of them has a slip rate above 0, it is a quarter of strength / impedance, the natural scale of the slip rate.
    """
    rates = [fold.rate for fold in contact.folds]
    rates += [rate for jump in contact.jumps for rate in (jump.rate_before, jump.rate_after)]
    found = max([*rates, *np.abs(path).tolist()], default=0.0)
    assert contact.resistance is not None
    return _ROOM * found if found > 0.0 else 0.25 * contact.resistance.strength / contact.resistance.impedance


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw the set in the plane of slip rate and load, and its mirror image too if the run slips backwards."""
    figure, grid = panels(1, 1, (5.4, 4.2))
    axes = grid[0, 0]
    strength = float(dataset["strength"])
    low, high = _range(dataset)
    near = high - low < _TINY * strength
    scale, origin = (1.0, strength) if near else (1e-6, 0.0)

    def height(excess: Any, sign: int = 1) -> Any:
        """Return the ordinate of the load strength + excess, near the strength as a difference, which loses no digit."""
        return scale * (sign * np.asarray(excess) + (sign * strength - origin))

    backwards = bool((dataset["path_slip_rate"].values < 0.0).any())
    for sign in (1, -1) if backwards else (1,):
        _draw_set(axes, dataset, sign, height)
    _draw_jumps(axes, dataset, height)
    _draw_path(axes, dataset, height)
    fastest = float(dataset["slip_rate"][-1])
    axes.set(
        xlabel=label(dataset["slip_rate"]),
        ylabel=r"load $\beta$ minus static strength (Pa)" if near else r"load $\beta$ (MPa)",
        xlim=(-fastest if backwards else -0.04 * fastest, fastest),
        ylim=(float(height(low)), float(height(high))),
    )
    axes.legend(loc="best")
    letter(axes, dataset.attrs["title"])
    return figure


def _range(dataset: xr.Dataset) -> tuple[float, float]:
    """Return the range of loads to be drawn, as excess (Pa): that of the curve, the end of stick and the run, with a margin."""
    inside = np.concatenate((dataset["excess"].values, [0.0], dataset["path_excess"].values))
    room = 0.08 * float(np.ptp(inside)) or 1.0
    return float(inside.min()) - room, float(inside.max()) + room


def _draw_set(axes: Axes, dataset: xr.Dataset, sign: int, height: Height) -> None:
    """Draw stick (vertical) and the stable, unstable and flat parts of the curve, or their mirror image for sign -1."""
    rate, excess, kind = (dataset[name].values for name in ("slip_rate", "excess", "kind"))
    stick = height(np.array([-float(dataset["strength"]), 0.0]), sign)
    look: dict[str, Any] = {"linewidth": 3.0} if sign > 0 else {"linewidth": 3.0, "label": None}
    axes.plot([0.0, 0.0], stick, **{"color": GREY, "label": "stick"} | look)
    draw_branches(axes, sign * rate, height(excess, sign), kind, **look)


def _draw_jumps(axes: Axes, dataset: xr.Dataset, height: Height) -> None:
    arrow = {"arrowstyle": "-|>", "color": GREEN, "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
    for before, after, excess in dataset["jump"].values.tolist():
        level = float(height(excess))
        axes.annotate("", (after, level), (before, level), arrowprops=arrow)
    if dataset.sizes["jumps"]:
        axes.plot([], [], color=GREEN, linewidth=1.2, label=f"jump, {dataset.attrs['rule']}")


def _draw_path(axes: Axes, dataset: xr.Dataset, height: Height) -> None:
    rate, load = dataset["path_slip_rate"].values, height(dataset["path_excess"].values)
    if not rate.size:
        return
    axes.plot(rate, load, color=INK, linewidth=1.0, label="run", zorder=4)
    for i, marker, name in ((0, "o", "its start"), (-1, "s", "its end")):
        axes.plot(rate[i], load[i], marker, color=INK, markersize=4.5, zorder=5, label=name, linestyle="")
