"""Engines that solve another problem than the one given: each number that a run is prepared with is made wrong by a factor 1 + e.

The run is then sound in itself. Only a proof that takes the problem's own numbers, or the energy balance, can notice it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

import stickslip as ss
from stickslip.engine.state.layout import FirstLoad, LadderCell, LawPiece, LoadingSegment, Params, Setup
from stickslip.engine_input import prepare
from stickslip.loading import PiecewiseLinear, Sinusoidal, Steps

SIZES = (1e-6, 1e-3)
"""Errors of a number, relative."""
HARM = 1e-9
"""A run is harmed if its slip differs from that of the right engine by more than this share (1) of the largest slip."""
NOTICED = 10.0
"""A measure notices an error if it is this many times what it is with the right engine (1)."""
NUMERICS = {
    *("tolerance", "first_disc", "smallest_jump", "relative_jump", "rate_floor", "shortest", "largest_drop", "state_scale"),
    *("can_be_negative", "counts_net", "healed_piece"),
}
"""Numbers that decide how a run is solved, or whether something applies, and not what."""
FLAGS = {"jump", "trip", "is_last", "shakes", "pulled"}
"""Whole numbers in tables."""

SLAB, BLOCK = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), ss.SpringBlock(1.0, 20.0, 10.0)
WEAKENS = ss.friction.FromExpression("0.55 + 0.03*sin(3*u)*exp(-u*u) + 0.01/(1 + u*u)")
COULOMB = ss.friction.Coulomb(0.6, 0.55)
AGEING = ss.friction.RateAndState(0.6, 0.012, 0.014, 0.01, normal_stress_coupling=0.005)
LAYERS = ss.LayeredSlab([4e3, 6e3], [2600.0, 2800.0], [3000.0, 3500.0], 1e8)


def cases() -> dict[str, tuple[ss.Problem, float]]:
    """Problems by name, with durations (s): each kind of thing that is given, on a slab, on a block, on layers, and turning."""
    friction, law = ss.friction, WEAKENS
    slips = {"pull_rate": 0.3, "initial_excess": 1.5e7}
    swings, climbs = Sinusoidal(1e8, 1e6, 3.0), PiecewiseLinear([0.0, 1.0, 2.5], [1e8, 1.02e8, 0.99e8])
    pulls = Sinusoidal(0.3, 0.1, 5.0)
    soft = replace(SLAB, driver_impedance=3e6)
    machine = {"driver_impedance": 3e6, "driver_inertia": 2e6, "driver_integral_gain": 4e5}
    freed = Steps([0.0, 5.0], [SLAB.reflection, 0.5])
    rests = {"pull_rate": 0.3, "initial_excess": -2e6}
    shakes = PiecewiseLinear([0.0, 1.0, 2.0, 3.0], [0.0, 0.2, -0.1, 0.0])
    found = {
        "slab, normal load swings": (ss.Problem(SLAB, law, **slips, normal_load=swings), 4.0),
        "slab, normal load climbs": (ss.Problem(SLAB, law, **slips, normal_load=climbs), 4.0),
        "block, normal load steps": (
            ss.Problem(BLOCK, law, pull_rate=0.1, initial_excess=4.0, normal_load=Steps([0.0, 0.3], [10.0, 11.0])),
            1.5,
        ),
        "slab rests, normal load climbs": (ss.Problem(SLAB, COULOMB, **rests, normal_load=climbs), 14.0),
        "ageing, normal load steps": (
            ss.Problem(
                SLAB,
                AGEING,
                pull_rate=1.0,
                initial_load=6.3e7,
                initial_state=1e-2,
                normal_load=Steps([0.0, 1.0, 2.0], [1e8, 1.02e8, 0.99e8]),
            ),
            4.0,
        ),
        "ageing, normal load swings": (
            ss.Problem(BLOCK, AGEING, pull_rate=0.1, initial_load=6.2, initial_state=1.0, normal_load=Sinusoidal(10.0, 0.5, 0.7)),
            0.5,
        ),
        "two states": (
            ss.Problem(
                SLAB,
                friction.TwoStateRateAndState(0.6, 0.012, 0.01, 0.01, second_b=0.004, second_distance=0.1),
                pull_rate=1.0,
                initial_load=6.3e7,
                initial_state=1e-2,
                initial_second_state=1e-1,
            ),
            4.0,
        ),
        "bristles": (ss.Problem(BLOCK, friction.LuGre(0.7, 0.5, 0.1, 1e3, 5.0, 0.02), pull_rate=0.1, initial_load=0.0), 3.0),
        "lagged": (ss.Problem(SLAB, friction.LaggedFriction(friction.HyperbolicRate(0.8, 0.3, 0.1), 0.5), **slips), 4.0),
        "slab under a swinging pull": (ss.Problem(SLAB, law, pull_rate=pulls, initial_excess=1.5e7), 20.0),
        "soft driver, far stress": (
            ss.Problem(soft, law, pull_rate=0.3, initial_excess=1.5e7, far_stress=7.6e7, far_stress_rate=1e5),
            20.0,
        ),
        "soft driver, far stress swings": (
            ss.Problem(soft, law, pull_rate=0.3, initial_excess=1.5e7, far_stress=Sinusoidal(7.6e7, 1e6, 4.0)),
            20.0,
        ),
        "machine": (ss.Problem(replace(SLAB, **machine), law, **slips), 20.0),
        "driver changes": (ss.Problem(SLAB, law, **slips, far_stress=7.5e7, driver_reflection=freed), 20.0),
        "shaken slab": (ss.Problem(SLAB, law, **slips, ground_velocity=shakes), 15.0),
        "shaken slab with mass": (
            ss.Problem(replace(SLAB, contact_mass=1e6), law, **slips, ground_acceleration=Sinusoidal(0.0, 0.5, 2.0)),
            4.0,
        ),
        "shaken block": (
            ss.Problem(BLOCK, law, pull_rate=0.1, initial_excess=4.0, ground_acceleration=Sinusoidal(0.0, 0.5, 0.7)),
            1.5,
        ),
        "block with damping": (ss.Problem(replace(BLOCK, damping=0.5), law, pull_rate=pulls, initial_excess=4.0), 3.0),
        "layers": (ss.Problem(LAYERS, law, **slips), 20.0),
        "layers, normal load swings": (ss.Problem(LAYERS, law, **slips, normal_load=swings), 8.0),
        "shaken layers": (ss.Problem(LAYERS, law, **slips, ground_velocity=shakes), 20.0),
        "layers with drag": (ss.Problem(replace(LAYERS, drag=[20.0, 10.0], driver_impedance=3e6), law, **slips), 20.0),
        "layers, driver changes": (ss.Problem(LAYERS, law, **slips, far_stress=7.5e7, driver_reflection=freed), 20.0),
        "machine behind layers": (ss.Problem(replace(LAYERS, **machine), law, **slips), 20.0),
        "two slabs": (ss.Problem(ss.TwoSlabs([4e3], [2600.0], [3000.0], [6e3], [2800.0], [3500.0], 1e8), law, **slips), 20.0),
        "joined slabs": (
            ss.Problem(
                ss.TwoSlabs(
                    [4e3],
                    [2600.0],
                    [3000.0],
                    [6e3],
                    [2800.0],
                    [3500.0],
                    1e8,
                    sides="joined",
                    driver_impedance=3e6,
                    other_driver_impedance=4e6,
                ),
                law,
                **slips,
            ),
            20.0,
        ),
    }
    disc = ss.RotatingBlock(2.0, 20.0, 10.0, damping=0.1)
    found["rotating block"] = ss.Problem(disc, law, pull_rate=0.1, initial_excess=4.0), 1.5
    for name in ("drill-string", "pipe-and-collar", "reversing-axis"):
        one = ss.load_scenario(name)
        found[name] = one.problem, min(one.duration, 3.0)
    return found


# ---- engines that are prepared with wrong numbers ------------------------------------------------------------------------------


class Place(NamedTuple):
    """Where a number of a prepared run stands: which table, its field, and its row and column in the table's numbers."""

    table: str
    field: str
    index: tuple[int, ...]

    @property
    def name(self) -> str:
        return f"{self.table}.{self.field}{list(self.index[:-1]) or ''}"


def places_in(setup: Setup) -> Iterator[Place]:
    """Yield the places of all numbers of a prepared run that are neither zero, nor infinite, nor decide only how it is solved."""
    for field, where in Params.places.items():
        yield from (Place("params", field, (n,)) for n in span(where) if field not in NUMERICS and counts(setup.params.numbers[n]))
    for table, kind in (("first_load", FirstLoad), ("loading", LoadingSegment), ("ladder", LadderCell), ("law", LawPiece)):
        rows = np.asarray(getattr(setup, table)).view(float)
        for field, where in kind.places.items():
            if field in FLAGS or field.endswith("_at"):
                continue
            for row in range(len(rows)):
                yield from (Place(table, field, (row, n)) for n in span(where) if counts(rows[row, n]))


def span(where: Any) -> range:
    """Return the columns of a field."""
    return range(where.first, where.first + where.size)


def counts(number: float) -> bool:
    """Return True for a number that can be made wrong by a factor."""
    return bool(np.isfinite(number)) and abs(number) > 1e-290


@contextmanager
def wrong_setup() -> Iterator[Callable[[Place | None, float], None]]:
    """Yield a function that makes one number of every run that is prepared from then on wrong by a factor 1 + e; None: none."""
    right, wrong = prepare._of_problem, []

    def prepared(problem: ss.Problem, rule: Any) -> Any:
        setup, state, count = right(problem, rule)
        for place, by in wrong:
            tables = {name: np.array(getattr(setup, name)) for name in setup._fields if name != "params"}
            params = Params(setup.params.numbers.copy())
            numbers = params.numbers if place.table == "params" else tables[place.table].view(float)
            numbers[place.index] *= 1.0 + by
            setup = Setup(params, **tables)
        return setup, state, count

    prepared.cache_clear = right.cache_clear  # type: ignore[attr-defined]

    def make_wrong(place: Place | None, by: float) -> None:
        wrong[:] = [(place, by)] if place else []
        prepare._prepared.cache_clear()

    prepare._of_problem = prepared  # type: ignore[assignment]
    try:
        yield make_wrong
    finally:
        prepare._of_problem = right
        prepare._prepared.cache_clear()


# ---- what notices them ------------------------------------------------------------------------------------------------------------

TIMES = 61
"""Number of times at which slips, and energies, of two runs are compared."""


def measures(run: ss.Solution) -> dict[str, float]:
    """Return what the proof and the energy balance say of a run: shares (1) of its normal load, slip, slip rate, state and heat."""
    proof, normal = run.proven, run.problem.normal
    times = np.linspace(0.0, run.duration, TIMES)[1:]
    energy = run.energy(times)
    slip, rate = (float(np.max(np.abs(one), initial=1e-300)) for one in (run.slip(times) - run.slip(0.0), run.slip_rate(times)))
    turned = float(np.abs(energy.heat).max() + np.abs(energy.work).max() + 1e-300)
    return {
        "contact": proof.residual / normal,
        "states": proof.states,
        "load": proof.load / normal,
        "rest": proof.rest / normal,
        "slip": proof.slip / slip,
        "rate": proof.rate / rate,
        "energy": float(np.abs(energy.balance).max()) / turned,
    }


FLOOR = 1e-13
"""Measures below this are rounding (1)."""


@dataclass
class Noticed:
    """What became of the runs of one problem that were prepared with wrong numbers."""

    runs: int = 0
    harmed: int = 0
    by: dict[str, int] = field(default_factory=dict)
    """Number of harmed runs that each measure notices."""
    unnoticed: list[str] = field(default_factory=list)
    """Harmed runs that none notices: this must not happen."""


def judge(name: str, problem: ss.Problem, duration: float, each: int = 1) -> Noticed:
    """Make every `each`-th number of a problem wrong in turn, and count what notices that; `name` is for those that nothing does."""
    found = Noticed()
    times = np.linspace(0.0, duration, TIMES)
    with wrong_setup() as make_wrong:
        make_wrong(None, 0.0)
        right = ss.simulate(problem, duration)
        before, slip = measures(right), right.slip(times)
        setup, _ = prepare.prepare(problem, right.rtol)
        for place in list(places_in(setup))[::each]:
            for size in SIZES:
                make_wrong(place, size)
                found.runs += 1
                try:
                    run = ss.simulate(problem, duration, max_pieces=20_000)
                except ss.InputError:
                    continue
                common = times[times <= run.duration]
                if np.abs(run.slip(common) - slip[: len(common)]).max() <= HARM * np.ptp(slip) and len(common) == TIMES:
                    continue
                found.harmed += 1
                now = measures(run)
                noticing = [key for key, one in now.items() if one > NOTICED * max(before[key], FLOOR)]
                for key in noticing:
                    found.by[key] = found.by.get(key, 0) + 1
                if not noticing:
                    found.unnoticed.append(f"{name}: {place.name} {size:g}")
    return found
