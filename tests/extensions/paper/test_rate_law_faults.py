"""The rate law along a fault, with a lag: crack or pulse, closed forms, a method of its own, and what the stored study says."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.special import ellipe

import stickslip as ss
from stickslip.extensions.paper.cases import problem
from stickslip.extensions.paper.claims.faults import pulses_in_3d
from stickslip.extensions.paper.rate_law_faults import (
    LAG,
    SLOWER_THAN_UNIFORM,
    LaggedFault,
    at,
    fall_at_front,
    largest_load_of_pulses,
    mode_of,
    numbers,
    slips_between,
)
from stickslip.extensions.paper.rate_law_report import (
    ANSWER,
    LAGS,
    alone_table,
    chosen,
    found_rows,
    front_speed,
    fronts,
    fronts_table,
    healing_speed,
    loads_table,
    meshes,
    most_pulses,
    orders,
    pulses_of_row,
)
from tests.extensions.planar.planar_methods import FrictionalVolume, PlanarCase

TRIP = 40.0 / 7.0
PAGE = Path(__file__).parents[3] / "docs" / "rate-law-on-a-fault.md"

IMPEDANCE, SPEED, MODULUS, STATIC, DYNAMIC = 9.8e6, 3500.0, 3.43e10, 80e6, 30e6
"""Those of the paper's slab and rate law: Pa s/m, m/s, Pa, Pa, Pa."""


@pytest.mark.parametrize(("factor", "printed"), [(1.0, 64.4719e6), (SLOWER_THAN_UNIFORM["line"], 70.0928e6), (2.0, 73.01e6)])
def test_the_largest_load_of_pulses_touches_the_steady_friction_from_below(factor: float, printed: float) -> None:
    """Beyond the peak at rest, Z v + S mu(v) has its least value there; the first is the paper's lower fold."""
    law = problem("fig6-slab").friction
    least = minimize_scalar(
        lambda v: factor * IMPEDANCE * v + 1e8 * float(law.coefficient(0.0, v)), bounds=(0.1, 10.0), method="bounded"
    )
    assert largest_load_of_pulses(factor) == pytest.approx(least.fun, rel=1e-9, abs=0.0)
    assert largest_load_of_pulses(factor) == pytest.approx(printed, rel=2e-4, abs=0.0)


def small(background: float, scale: float = 1.0) -> ss.PlanarSolution:
    """Return the run of a fault of 60 km in 2D with a lag of 0.4 s, for 7 s; all lengths and times are larger by a scale."""
    fault = LaggedFault(background, 0.4 * scale, 240, 60e3 * scale, 5e3 * scale)
    return ss.simulate(fault.slab, 7.0 * scale, frames=200)


@pytest.fixture(scope="module")
def pulse() -> ss.PlanarSolution:
    return small(60e6)


@pytest.fixture(scope="module")
def crack() -> ss.PlanarSolution:
    return small(75e6)


def test_below_the_lower_fold_slip_heals_by_itself_and_the_healing_outruns_waves(pulse: ss.PlanarSolution) -> None:
    """Cochard & Madariaga 1994 (Pure Appl. Geophys. 142, 419) say this of rate weakening in antiplane, without a number."""
    spans = [slips_between(pulse.times, at(pulse, place, pulse.slip_rate)) for place in (0.0, 8e3, 12e3)]
    (_, middle), (arrives, heals), (later, _) = spans
    assert mode_of(pulse) == "pulse"
    assert middle < heals < 5.0  # no wave comes back: the driver absorbs them, and replicas are 17 s away
    assert 8e3 / (heals - middle) > 1.3 * SPEED
    assert 0.5 * SPEED < 4e3 / (later - arrives) < SPEED


def test_a_front_stops_by_itself_if_the_load_ahead_is_low() -> None:
    run = small(45e6)
    slipped = np.isfinite(run.rupture_times)
    assert 10e3 < np.abs(run.slab.y[slipped]).max() < 20e3
    assert not run.slip_rate[-1].any()


def test_far_above_the_lower_fold_slip_is_a_crack_that_slows_down_to_kostrovs_rate(crack: ss.PlanarSolution) -> None:
    """The middle slips at v with (pi/2) Z v + S mu(v) = load if the ends ran at c; friction near them is lower, so it is faster."""
    assert mode_of(crack) == "crack"
    law = problem("fig6-slab").friction
    found = float(at(crack, 0.0, crack.slip_rate)[-1])
    needed = SLOWER_THAN_UNIFORM["line"] * IMPEDANCE * found + 1e8 * float(law.coefficient(0.0, found))
    assert 75e6 < needed < 1.1 * 75e6
    assert np.all(crack.slip_rate[-1][np.abs(crack.slab.y) < 12e3] > 1.5)


@pytest.mark.slow
def test_the_rate_law_has_no_length_so_that_the_lag_alone_sets_the_scale(pulse: ss.PlanarSolution) -> None:
    """Lag, lengths and times doubled: the same slip rates and twice the slip. A lag to 0 is a fault that grows."""
    large = small(60e6, 2.0)
    assert large.slip_rate == pytest.approx(pulse.slip_rate, rel=1e-6, abs=1e-8)
    assert large.slip == pytest.approx(2.0 * pulse.slip, rel=1e-6, abs=1e-8)


def fastest_growth(fall: float, wavenumber: float) -> float:
    """Return the fastest growth (1/lag) of disturbances of steady sliding, `wavenumber` times c times the lag.

    It is the largest real part of the roots of sqrt(l^2 + k^2) (1 + l) = fall l, with a root of positive real part, since waves
    leave; friction falls with the slip rate by `fall` Z.
    """
    found = np.roots([1.0, 2.0, 1.0 + wavenumber**2 - fall**2, 2.0 * wavenumber**2, wavenumber**2]).astype(complex)
    outward = np.sqrt(found**2 + wavenumber**2)
    outward = np.where(outward.real < 0.0, -outward, outward)
    return float(found[np.abs(outward * (1.0 + found) - fall * found) < 1e-6].real.max())


def test_in_1d_the_jump_takes_a_time_in_proportion_to_the_lag_and_has_the_height_of_the_shock() -> None:
    """Z lag dw/dt = load - g(w) holds no other time: from 0.5 to 3 m/s in half of the time for half of the lag."""
    took = []
    for lag in (0.2, 0.1):
        run = ss.simulate(LaggedFault(81e6, lag, reflects=True).problem, 5.5)
        times = np.linspace(0.0, 5.5, 200_001)
        rate = run.slip_rate(times)
        took.append(float(np.ptp(np.interp([0.5, 3.0], rate, times))))
    assert took[1] == pytest.approx(0.5 * took[0], rel=1e-3, abs=0.0)
    settled = float(rate[-1])
    assert IMPEDANCE * settled + DYNAMIC + (STATIC - DYNAMIC) / (1.0 + settled) == pytest.approx(81e6, rel=1e-6, abs=0.0)


def test_with_a_lag_no_disturbance_grows_faster_than_in_1d() -> None:
    """By (fall - 1)/lag at most, and the slower the shorter it is: without a lag there is no such bound."""
    rates = [fastest_growth(2.25, k) for k in (1e-3, 0.1, 0.3, 1.0, 3.0, 10.0, 100.0)]
    assert rates == sorted(rates, reverse=True)
    assert rates[0] == pytest.approx(1.25, abs=1e-5)
    assert rates[-1] == pytest.approx(2.25**2 / 100.0**2, rel=0.05, abs=0.0)


@pytest.mark.slow
def test_a_disturbance_of_steady_sliding_grows_as_the_closed_form_says() -> None:
    """Wavenumber 0.3 over c times the lag, at 0.5 m/s; runs with steps in a ratio of two, extrapolated at order 2, to 0.3 %."""
    slab = ss.ElasticSlab(2800.0, SPEED, 1e4, 1e8, driver_impedance=IMPEDANCE)
    law = ss.friction.LaggedFriction(problem("fig6-slab").friction, time=1.0)
    load, length = IMPEDANCE * 0.5 + DYNAMIC + (STATIC - DYNAMIC) / 1.5, 2.0 * math.pi * SPEED / 0.3
    start, found = ss.Problem(slab, law, initial_load=load, initial_state=0.5), []
    for courant in (0.125, 0.0625):
        more = {"initial.load": lambda y: load * (1.0 + 1e-7 * np.cos(2.0 * math.pi * y / length))}
        run = ss.simulate(ss.PlanarSlab(start, nodes=16, length=length, along=more, courant=courant), 7.5, frames=100)
        size = np.log(np.abs(np.ptp(run.slip_rate, axis=1)))
        late = run.times > 6.5
        found.append(np.polyfit(run.times[late], size[late], 1)[0])
    fall = (STATIC - DYNAMIC) / 1.5**2 / IMPEDANCE
    assert (4.0 * found[1] - found[0]) / 3.0 == pytest.approx(fastest_growth(fall, 0.3), rel=0.003, abs=0.0)


class LagAtNodes:
    """Friction S mu(w) with lag dw/dt = v - w for the volume method: w in the middle of a step follows from the slip rate of it."""

    def __init__(self, count: int, lag: float, step: float) -> None:
        self.state, self.share = np.zeros(count), 0.5 * step / lag

    def middle(self, rate: NDArray[np.float64], nodes: NDArray[np.intp]) -> NDArray[np.float64]:
        """Return w in the middle of the step."""
        return (self.state[nodes] + self.share * rate) / (1.0 + self.share)

    def __call__(self, slip: NDArray[np.float64], rate: NDArray[np.float64], nodes: NDArray[np.intp]) -> tuple[np.ndarray, ...]:
        """Return strength (Pa), and its derivatives by slip and slip rate."""
        lower = 1.0 + self.middle(rate, nodes)
        by_rate = -(STATIC - DYNAMIC) / lower**2 * self.share / (1.0 + self.share)
        return DYNAMIC + (STATIC - DYNAMIC) / lower, np.zeros(len(slip)), by_rate


@pytest.mark.slow
def test_the_volume_method_sees_the_same_pulse() -> None:
    """A fault of 20 km under a driver at 10 km, until the echo has come back: slip to 0.3 % on average, and 2 % anywhere."""
    nodes, lag, until = 192, 0.5, 6.0
    fault = LaggedFault(60e6, lag, nodes, 20e3, 3e3, reflects=True)
    run = ss.simulate(fault.slab, until, frames=100)
    steps = 226  # of a two-way time, so that c dt is 0.85 of the distance of nodes
    friction = LagAtNodes(nodes, lag, 2e4 / SPEED / steps)
    case = PlanarCase(2800.0, SPEED, 1e4, (20e3,), fault.slab.values.load, friction)
    volume = FrictionalVolume(case, steps, until)
    while volume.time < until - 1e-9:
        volume.advance()
        rate = np.abs(volume.slip_rate)
        friction.state = 2.0 * friction.middle(rate, np.arange(nodes)) - friction.state
    seen = np.array([np.interp(volume.time, run.times, one) for one in run.slip.T])
    assert 4.0 < seen.min() < seen.max() < 10.0
    missed = np.abs(volume.slip - seen) / seen.max()
    assert missed.mean() < 0.003
    assert missed.max() < 0.02


@pytest.mark.slow
def test_a_front_that_runs_steadily_leaves_kostrovs_slip_rate() -> None:
    """A lag in proportion to the distance leaves no length: the speed V of the front is constant, and it need not be told.

    In the middle of a crack whose ends run at V, a stress drop D gives the slip rate D V/(G E(m)), E the complete elliptic
    integral, m = 1 - V^2/c^2; the nucleus, a line of force F per length, adds F/(pi G t). Allowed: 2 %.
    """
    slab = ss.ElasticSlab(2800.0, SPEED, 1e4, 1e8, driver_impedance=IMPEDANCE)
    law = ss.friction.LaggedFriction(ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=20.0), time=1.0)
    load, nucleus, until = 60e6, 2e3, 5.0
    fault = ss.PlanarSlab(
        ss.Problem(slab, law, initial_load=load),
        nodes=320,
        length=40e3,
        along={
            "initial.load": lambda y: np.where(np.abs(y) < nucleus, 81e6, load),
            "friction.time": lambda y: 0.3e-3 * np.maximum(np.abs(y), 500.0),
        },
    )
    run = ss.simulate(fault, until, frames=300)
    speeds = []
    for low, high in ((6e3, 10e3), (10e3, 15e3)):
        there = (fault.y > low) & (fault.y < high)
        speeds.append(np.polyfit(run.rupture_times[there], fault.y[there], 1)[0])
    assert speeds[1] == pytest.approx(speeds[0], rel=0.02, abs=0.0)
    speed, inside = speeds[1], np.abs(fault.y) < 0.8 * speeds[1] * until
    drop = load - run.traction[-1][inside].mean()
    crack = drop * speed / (MODULUS * ellipe(1.0 - (speed / SPEED) ** 2))
    force = (81e6 - load) * 2.0 * nucleus / (math.pi * MODULUS * until)
    assert float(at(run, 0.0, run.slip_rate)[-1]) == pytest.approx(crack + force, rel=0.02, abs=0.0)


def test_the_fall_at_a_front_is_read_between_samples() -> None:
    times = np.linspace(0.0, 2.0, 41)
    traction = np.interp(times, [0.5, 1.5], [80e6, 30e6])
    assert fall_at_front(times, traction) == pytest.approx((1.0, 0.8), rel=1e-9, abs=0.0)


# ---- the stored study ----------------------------------------------------------------------------------------------------------


def test_the_page_has_the_rows_of_the_stored_study() -> None:
    page = PAGE.read_text(encoding="utf-8")
    rows = [*loads_table(), *alone_table(), *fronts_table()]
    assert len(rows) > 20
    for row in rows:
        assert f"| {' | '.join(row.values())} |" in page


def test_stored_slip_heals_below_the_fold_goes_on_far_above_it_and_comes_back_between() -> None:
    """In 2D without echo; the limits are closed forms."""
    rows = [
        row for row in chosen(group="load", law="lag", shape="line", driver="none") if float(row["lag [s] or distance [m]"]) == LAG
    ]
    assert len(rows) == 9
    fold, cracks = largest_load_of_pulses(), largest_load_of_pulses(SLOWER_THAN_UNIFORM["line"])
    for row in rows:
        load = 1e6 * float(row["background [MPa]"])
        assert (row["rest, 0 km [s]"] == "") == (row["mode"] == "crack")
        if load < fold:
            assert float(row["rest, 0 km [s]"]) < 4.1
        if load > cracks + 4e6:
            assert row["mode"] == "crack"
        if abs(load - cracks) < 3e6:
            assert most_pulses(row) > 1
        assert 0.8 < front_speed(row) < 1.02  # c, to the steps in which arrivals are read
    assert healing_speed(next(row for row in rows if row["background [MPa]"] == "60")) > 2.0


def test_slip_out_of_a_nucleus_is_one_pulse_where_the_driver_reflects() -> None:
    for shape in ("line", "plane"):
        rows = chosen(group="load", law="lag", shape=shape, driver="rigid")
        assert len(rows) == 3
        for row in rows:
            assert most_pulses(row) == 1, row
            assert float(row["rest, 0 km [s]"]) < TRIP + 0.3


def test_on_faults_loaded_alike_the_middle_has_one_pulse_and_long_faults_several_off_the_middle_before_the_echo() -> None:
    times = {}
    for row in chosen(group="alone", shape="line"):
        ends = float(row["ends [km]"])
        assert len(row["pulses, 0 km [s]"].split()) == 1
        assert 0.5 * ends * 2.0 / 3.5 < float(row["rest, 0 km [s]"]) < ends / 3.5 + 0.8
        times[ends] = np.array(row["pulses, 8 km [s]" if ends == 10.0 else "pulses, 16 km [s]"].split(), float)
    assert [int(np.sum(times[ends] < TRIP)) for ends in (10.0, 20.0)] == [3, 3]


def test_stored_slip_on_planes_has_its_window_around_the_limit_of_round_cracks() -> None:
    modes = {row["background [MPa]"]: row["mode"] for row in chosen(group="load", law="lag", shape="plane", driver="none")}
    assert modes == {"60": "pulse", "66": "pulse", "70": "pulse", "75": "several pulses", "78": "crack"}
    assert 70e6 < largest_load_of_pulses(SLOWER_THAN_UNIFORM["plane"]) < 75e6


def test_second_pulses_of_far_places_at_low_loads_are_told_wherever_the_answer_is() -> None:
    """At 50 and 55 MPa in 2D places at 16 or 24 km see two pulses while the middle sees one; page, claim and answer say so."""
    rows = chosen(LAGS["line"], group="load", law="lag", shape="line", driver="none")
    low = {row["background [MPa]"]: pulses_of_row(row) for row in rows if float(row["background [MPa]"]) < 60.0}
    assert low == {"50": [1, 1, 2, 2], "55": [1, 1, 1, 2]}
    answer = PAGE.read_text(encoding="utf-8").partition("![")[0]
    why = pulses_in_3d(None).explanation  # type: ignore[arg-type]
    assert "at 50 and 55 MPa in 2D far places see two" in answer
    assert "In 3D one load shows it, 75 MPa" in answer
    assert "At low loads in 2D, 50 and 55 MPa, far places see two pulses" in why
    assert "At low loads in 2D far places see two" in ANSWER


@pytest.mark.parametrize("load", ["60", "70", "75"])
def test_stored_grids_converge_in_slip(load: str) -> None:
    """Grids of 512, 1024 and 2048 nodes: the differences fall, to below 1 % of the slip."""
    slip = meshes(load)
    first, second = np.abs(np.diff(slip))
    assert second < 0.75 * first
    assert second < 0.01 * slip[-1]


def test_stored_fronts_become_steeper_faster_than_the_lag_shrinks() -> None:
    for load in ("60", "75"):
        lag, fall, peak = fronts(load)
        assert len(lag) == 4
        assert np.all(orders(fall, lag) > 1.1)
        assert np.all(orders(fall, lag) < 2.0)
        assert np.all(orders(peak, lag) < -0.4)
        assert np.all(np.isfinite(numbers(chosen(group="front"), "half fallen, 12 km [s]")))


@pytest.mark.slow
def test_in_3d_the_middle_of_a_round_crack_slips_as_under_twice_the_impedance() -> None:
    """At 78 MPa, on 64 x 64 nodes: to 3 % of the load."""
    run = ss.simulate(LaggedFault(78e6, 2.0 * LAG, 64, 96e3, 8e3, "plane").slab, 12.0, frames=100)
    assert mode_of(run) == "crack"
    found = float(at(run, 0.0, run.slip_rate)[-1])
    needed = SLOWER_THAN_UNIFORM["plane"] * IMPEDANCE * found + 1e8 * float(problem("fig6-slab").friction.coefficient(0.0, found))
    assert needed == pytest.approx(78e6, rel=0.03, abs=0.0)


@pytest.mark.slow
@pytest.mark.parametrize(("shape", "load", "nodes"), [("line", "70", 512), ("plane", "75", 64)])
def test_a_stored_row_is_what_the_run_gives(shape: str, load: str, nodes: int) -> None:
    """The same mode, the same slip in the middle to 1e-3, and the time of its rest to a frame."""
    rows = found_rows(LAGS[shape], group="load", law="lag", shape=shape, driver="none", nodes=f"{nodes}")
    row = next(row for row in rows if row["background [MPa]"] == load)
    extent = {"line": (LAG, nodes), "plane": (2.0 * LAG, nodes, 96e3, 8e3, "plane")}[shape]
    fault, frames = LaggedFault(float(load) * 1e6, *extent), {"line": 250, "plane": 100}[shape]
    run = ss.simulate(fault.slab, float(row["duration [s]"]), frames=frames)
    assert mode_of(run) == row["mode"]
    assert float(at(run, 0.0, run.slip)[-1]) == pytest.approx(float(row["slip in the middle [m]"]), rel=1e-3, abs=0.0)
    arrives, rests = slips_between(run.times, at(run, 0.0, run.slip_rate))
    assert (arrives, rests) == pytest.approx((0.0, float(row["rest, 0 km [s]"])), abs=0.12 if shape == "plane" else 0.03)
