"""Figure of the admissible set K of any problem: its branches by stability, the jumps of its selection rule, and a run's path."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import Normalize
from matplotlib.ticker import FuncFormatter

from stickslip.contact import Uniqueness, resistance, uniqueness_of
from stickslip.figures.panels import finish
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    PURPLE,
    VERMILLION,
    curve_label,
    curve_quantity,
    label,
    quantity,
    styled,
    title_of,
    unit_shown,
)
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import readable_unit
from stickslip.foundation.place import Place
from stickslip.problem import Problem, Resistance

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.solution import Solution

BRANCHES = {1: ("slip, stable", BLUE, "-"), -1: ("slip, unstable", VERMILLION, "--"), 0: ("slip, continuum", PURPLE, "-")}
"""Legend, colour and line style of the parts of the curve: 1 stable, -1 unstable, 0 a continuum of solutions."""
_POINTS = 1201
"""Evaluate the curve at this many slip rates."""
_ROOM = 1.25
"""The curve ends at this multiple of the largest slip rate of interest, so that all folds, jumps and the run lie inside."""
_TINY = 1e-3
"""If the loads span less than this share of the static strength, they are drawn as differences from it."""
_SETS = 8
"""Draw the set at this many slips if friction depends on slip."""
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)
"""The golden ratio; its multiples, less their whole parts, spread evenly without a period."""
_ARROWS = 0.3, 14
"""Distance between the arrows on the path, as a share of the axes, and about how many there are at most."""


def admissible_data(
    problem: Problem, solution: Solution | None = None, *, title: str = "", law_slip: float | None = None
) -> xr.Dataset:
    """Return the set K for forward slip at the start of a problem, or at `law_slip` (m), and the path of a run in it, as a dataset.

    It holds the curve as excess over the static strength at the start (Pa) along `slip_rate` (m/s); `kind` (1 stable, -1 unstable,
    0 continuum); the static strength (Pa); the jumps of the selection rule, shape (jumps, 3): slip rate before and after (m/s),
    excess (Pa); and the path of the run: slip rate (m/s), excess (Pa) and slip of the law (m), empty if no run is given.

    If friction depends on slip, the set moves as the contact slips: at each moment the run is on the set of its own slip. If the
    run slips, `set_slip` (m) are then some slips of the law that it passes, and `set_excess` (Pa), `set_kind` and `set_strength`
    (Pa, minus that at the start) are the sets there. The title is by default that of the run.

    Units are those of a slab; a string has N m for Pa, and rad for m. Raises InputError for a block, a contact mass, or a law with
    a state variable: the slip rate is then a state, or follows from one, and there is no such set.
    """
    contact = uniqueness_of(problem, law_slip)
    g = contact.resistance
    if g is None:
        why = "the slip rate does not follow from the load alone (inertia or a state variable)"
        raise InputError(f"figure of the set K: {why}: there is no set K to draw")
    path, loads = _path(solution, g.strength, problem), problem.load_unit
    ends = [rate for b in contact.branches for rate in (b.rate_from, b.rate_to) if np.isfinite(rate)]
    rates = np.union1d(np.linspace(0.0, _fastest(contact, path["path_slip_rate"].values), _POINTS), ends)
    inside = [(b.rate_from <= rates) & (rates <= b.rate_to) for b in contact.branches]
    flat = [(p.rate_from <= rates) & (rates <= p.rate_to) for p in contact.plateaus]
    kind = np.where(np.any(inside, axis=0), 1, -1)
    kind = np.where(np.any(flat, axis=0), 0, kind) if flat else kind
    jumps = np.array([(j.rate_before, j.rate_after, j.load - g.strength) for j in contact.jumps]).reshape(-1, 3)
    rate = problem.unit_of("slip_rate")
    contents = {
        "excess": quantity("slip_rate", g.excess(rates), "load minus static strength", r"\beta - S\mu_s", loads),
        "kind": xr.Variable("slip_rate", kind, {"long_name": "1 stable, -1 unstable, 0 continuum"}),
        "strength": quantity((), g.strength, "static strength", r"S\mu_s", loads),
        "jump": xr.Variable(
            ("jumps", "value"), jumps, {"long_name": f"rate before ({rate}), rate after ({rate}), excess ({loads})"}
        ),
    }
    coordinates = {"slip_rate": curve_quantity("slip_rate", rates, "slip_rate", loads)}
    title = title or ("" if solution is None else title_of(solution))
    attributes = {"title": title, "rule": contact.rule, "load_unit": loads}
    moved = _moved(problem, g, rates, path["path_law_slip"].values)
    return xr.Dataset(contents | path | moved, coords=coordinates, attrs=attributes)


def _path(solution: Solution | None, strength: float, problem: Problem) -> dict[str, xr.Variable]:
    rate = load = slip = np.zeros(0)
    loads = problem.load_unit
    if solution is not None:
        time, (rate, load) = solution.curves_together(("slip_rate", "load"))
        slip = solution.history.law_slip(solution.history.find(time, "right"))
    return {
        "path_slip_rate": quantity("path", rate, "slip rate of the run", "v", problem.unit_of("slip_rate")),
        "path_excess": quantity(
            "path", load - strength, "load of the run minus static strength", r"\beta - S\mu_s", problem.load_unit
        ),
        "path_law_slip": curve_quantity("path", slip, "slip", loads),
    }


def _moved(problem: Problem, start: Resistance, rates: Floats, slips: Floats) -> dict[str, xr.Variable]:
    """Return the sets at some slips (m) that a run passes; none if friction does not depend on slip or the run does not slip."""
    moves = problem.friction.depends_on_slip and slips.size > 0 and np.ptp(slips) > 0.0
    # Evenly spaced slips could all lie at the same phase of a law that is periodic in slip; those of the golden ratio do not.
    shares = np.sort([*(_GOLDEN * np.arange(_SETS - 1) % 1.0), 1.0])
    chosen = slips.min() + np.ptp(slips) * shares if moves else np.zeros(0)
    sets = [resistance(problem, float(slip)) for slip in chosen]
    shape = (len(sets), len(rates))
    strength = np.array([g.strength - start.strength for g in sets])
    excess = np.array([g.excess(rates) for g in sets]).reshape(shape) + strength[:, None]
    kind = np.sign(np.array([g.slope(rates) for g in sets]).reshape(shape)).astype(int)
    return {
        "set_slip": curve_quantity("set", chosen, "slip", problem.load_unit),
        "set_strength": quantity("set", strength, "static strength minus that at the start", "", problem.load_unit),
        "set_excess": quantity(("set", "slip_rate"), excess, "load minus static strength at the start", "", problem.load_unit),
        "set_kind": xr.Variable(("set", "slip_rate"), kind, {"long_name": "1 stable, -1 unstable, 0 continuum"}),
    }


def _fastest(contact: Uniqueness, path: Floats) -> float:
    """Return the end of the axis of slip rates (m/s), beyond every fold, every jump and the run.

    If none of them has a slip rate above 0, it is a quarter of strength / impedance, the natural scale of the slip rate.
    """
    rates = [fold.rate for fold in contact.folds]
    rates += [rate for jump in contact.jumps for rate in (jump.rate_before, jump.rate_after)]
    found = max([*rates, *np.abs(path).tolist()], default=0.0)
    assert contact.resistance is not None
    return _ROOM * found if found > 0.0 else 0.25 * contact.resistance.strength / contact.resistance.damping


@styled
def draw_admissible(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure | Axes:
    """Draw the set in the plane of slip rate and load, and its mirror image too if the run slips backwards.

    If friction depends on slip, the sets at some slips and the path of the run have the colour of the slip.
    """
    moves = dataset.sizes["set"] > 0
    axes = one_panel((6.4 if moves else 5.4, 4.2), **place)
    scales = _Scales(dataset)
    backwards = bool((dataset["path_slip_rate"].values < 0.0).any())
    for sign in (1, -1) if backwards else (1,):
        if moves:
            _draw_sets(axes, dataset, sign, scales)
        else:
            _draw_set(axes, dataset, sign, scales)
    if not moves:
        _draw_jumps(axes, dataset, scales)
    fastest = float(scales.rates(dataset["slip_rate"])[-1])
    axes.set(
        xlabel=label(dataset["slip_rate"], scales.rate),
        ylabel=scales.label,
        xlim=(-fastest if backwards else -0.04 * fastest, fastest),
        ylim=scales.limits,
    )
    _draw_path(axes, dataset, scales)
    axes.legend(loc="best")
    return finish(axes, dataset.attrs["title"], **place)


class _Scales:
    """The units of the drawn slip rates and loads of a dataset; near the strength loads are differences from it."""

    def __init__(self, dataset: xr.Dataset) -> None:
        names = ("excess", "path_excess", "set_excess", "set_strength")
        inside = np.concatenate([[0.0], *(dataset[name].values.ravel() for name in names)])
        self.strength = float(dataset["strength"])
        near = np.ptp(inside) < _TINY * self.strength
        self.origin = self.strength if near else 0.0
        self.load = readable_unit(dataset.attrs["load_unit"], inside + (self.strength - self.origin))
        self.rate = unit_shown(dataset["slip_rate"])
        self.label = rf"load $\beta$ {'minus static strength ' if near else ''}({self.load[0]})"
        room = 0.08 * float(np.ptp(inside)) or 1.0
        self.limits = float(self.height(inside.min() - room)), float(self.height(inside.max() + room))

    def height(self, excess: Any, sign: int = 1) -> Any:
        """Return the ordinate of the load strength + excess, near the strength as a difference, which loses no digit."""
        return (sign * np.asarray(excess) + (sign * self.strength - self.origin)) / self.load[1]

    def rates(self, values: Any) -> Floats:
        """Return slip rates (m/s) in the unit of the drawing."""
        return np.asarray(values, float) / self.rate[1]


def _draw_set(axes: Axes, dataset: xr.Dataset, sign: int, scales: _Scales) -> None:
    """Draw stick (vertical) and the stable, unstable and flat parts of the curve, or their mirror image for sign -1."""
    rate, excess, kind = (dataset[name].values for name in ("slip_rate", "excess", "kind"))
    stick = scales.height(np.array([-scales.strength, 0.0]), sign)
    look: dict[str, Any] = {"linewidth": 3.0} if sign > 0 else {"linewidth": 3.0, "label": None}
    axes.plot([0.0, 0.0], stick, **{"color": GREY, "label": "stick"} | look)
    draw_branches(axes, sign * scales.rates(rate), scales.height(excess, sign), kind, **look)


def draw_branches(axes: Axes, rate: Floats, load: Floats, kind: Any, **look: Any) -> None:
    """Draw the stable, unstable and flat parts of a curve, told apart by `kind`; `look` replaces colours, widths and labels."""
    for which, (name, colour, style) in BRANCHES.items():
        chosen = kind == which
        if not chosen.any():
            continue
        if which != 1:  # extend each part to the first point of its neighbours: the curve then has no gap
            chosen = chosen | np.append(chosen[1:], False) | np.append(False, chosen[:-1])
        axes.plot(rate, np.where(chosen, load, np.nan), **{"color": colour, "linestyle": style, "label": name} | look)


def _draw_sets(axes: Axes, dataset: xr.Dataset, sign: int, scales: _Scales) -> None:
    """Draw the sets at some slips in the colours of these, and stick up to the largest strength among them."""
    strength = dataset["set_strength"].values
    stick = scales.height(np.array([-scales.strength, strength.max()]), sign)
    axes.plot([0.0, 0.0], stick, color=GREY, linewidth=3.0, label="stick, up to the strength at each slip" if sign > 0 else None)
    colour, rate = _colours(dataset), sign * scales.rates(dataset["slip_rate"])
    for k, slip in enumerate(dataset["set_slip"].values):
        look: dict[str, Any] = {"color": colour.to_rgba(slip), "linewidth": 1.2, "label": None}
        draw_branches(axes, rate, scales.height(dataset["set_excess"].values[k], sign), dataset["set_kind"].values[k], **look)
    if sign > 0:
        for which, (name, _, style) in BRANCHES.items():
            if (dataset["set_kind"].values == which).any():
                axes.plot([], [], color=GREY, linewidth=1.2, linestyle=style, label=f"{name}, at the slip of its colour")


def _colours(dataset: xr.Dataset) -> ScalarMappable:
    slips = dataset["set_slip"].values
    return ScalarMappable(Normalize(slips[0], slips[-1]), "viridis_r")


def _draw_jumps(axes: Axes, dataset: xr.Dataset, scales: _Scales) -> None:
    arrow = {"arrowstyle": "-|>", "color": GREEN, "linewidth": 1.2, "shrinkA": 0, "shrinkB": 0}
    for before, after, excess in dataset["jump"].values.tolist():
        level = float(scales.height(excess))
        axes.annotate("", (after / scales.rate[1], level), (before / scales.rate[1], level), arrowprops=arrow)
    if dataset.sizes["jumps"]:
        axes.plot([], [], color=GREEN, linewidth=1.2, label=f"jump, {dataset.attrs['rule']}")


def _draw_path(axes: Axes, dataset: xr.Dataset, scales: _Scales) -> None:
    """Draw the path of the run, with arrows along it, a large open circle at its start and a square at its end."""
    rate, load = scales.rates(dataset["path_slip_rate"]), scales.height(dataset["path_excess"].values)
    if not rate.size:
        return
    moves = dataset.sizes["set"] > 0
    name, width = ("run, in the colour of its slip", 2.2) if moves else ("run", 1.0)
    axes.plot(rate, load, color=INK, linewidth=width, label=name, zorder=4)
    if moves:
        unit, size = unit_shown(dataset["set_slip"])
        points = np.stack([rate, load], axis=1)
        slip, colour = dataset["path_law_slip"].values, _colours(dataset)
        hues: Any = colour.to_rgba(0.5 * (slip[:-1] + slip[1:]))
        steps = list(np.stack([points[:-1], points[1:]], axis=1))
        axes.add_collection(LineCollection(steps, colors=hues, linewidths=1.5, zorder=4.1), autolim=False)
        bar = axes.figure.colorbar(colour, ax=axes, pad=0.02)
        bar.set_label(curve_label("slip", unit, dataset.attrs["load_unit"]))
        bar.ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / size:.4g}"))
    _draw_arrows(axes, rate, load)
    look: dict[str, Any] = {"color": INK, "linestyle": "", "clip_on": False}
    ring: dict[str, Any] = {"markersize": 9.0, "markerfacecolor": "none", "markeredgewidth": 1.5, "zorder": 6}
    axes.plot(rate[0], load[0], "o", label="its start", **ring, **look)
    axes.plot(rate[-1], load[-1], "s", markersize=4.5, zorder=5, label="its end", **look)


def _draw_arrows(axes: Axes, x: Floats, y: Floats) -> None:
    """Draw heads of arrows along a line, at equal distances as seen in the axes."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    along = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x) / (right - left), np.diff(y) / (high - low)))])
    if along[-1] == 0.0:
        return
    spacing = max(_ARROWS[0], along[-1] / _ARROWS[1])
    for place in np.arange(0.5 * spacing, along[-1], spacing):
        tail, head = ((float(np.interp(at, along, x)), float(np.interp(at, along, y))) for at in (place - 0.02, place + 0.02))
        arrow = {"arrowstyle": "-|>", "color": INK, "linewidth": 0.0, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 11}
        axes.annotate("", head, tail, arrowprops=arrow, zorder=5)
