"""What the soak found: each a small problem that ended wrongly, or not at all, until it was mended."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss

F = ss.friction


@pytest.mark.parametrize("excess", [1e-2, 1e-3, 1e-6])
def test_block_under_lagged_strengthening_friction_comes_to_rest(excess: float) -> None:
    """It swings once, m = K = S = 1, and stops after half a period: the load is then below the static strength for ever."""
    law = F.LaggedFriction(rate=F.HyperbolicRate(static=0.25, dynamic=0.7, alpha=0.06), time=0.03)
    run = ss.simulate(ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), law, initial_excess=excess), 24.0, max_pieces=2000)
    assert run.status.ok
    assert float(run.slip(24.0)) == pytest.approx(2.0 * excess, rel=1e-1)
    assert float(run.slip_rate(24.0)) == 0.0


@pytest.mark.slow
def test_catalogue_lists_events_whose_slip_rate_decays_to_nothing() -> None:
    """A block decays to 1e-320 m/s, where no bisection of a polynomial ever finds its end: the events must still be told."""
    body = ss.SpringBlock(2275678257.084148, 64.51469373151718, 248686543.23331934, damping=38316.404553044464)
    law = F.RateAndState(
        reference=0.20941955265049594,
        a=0.9725884113358655,
        b=0.31950710216277534,
        distance=25859.667578251894,
        rate=120.67254726230469,
        evolution="slip",
    )
    problem = ss.Problem(body, law, initial_load=10860563.18593456, initial_state=190.3023689830977)
    run = ss.simulate(problem, 662652289.7250804, rtol=1e-6)
    assert len(run.events) == 1
    assert run.events.peak_rate[0] == pytest.approx(float(abs(run.slip_rate(run.events.peak_time[0]))))


def test_load_that_passes_through_zero_early_in_a_long_interval_turns_the_slip() -> None:
    """The load is known to 1e-14 of all that it becomes in the stretch: a load below that is zero for the slip rate, too."""
    body = ss.ElasticSlab(4267.6862547198725, 22337.107295672147, 236.83197284906433, 75430256.50642161)
    law = F.RateAndState(
        reference=0.9976617974819258,
        a=0.7488153835377066,
        b=0.9500889195867108,
        distance=0.00798086977478755,
        rate=1e-6,
        evolution="slip",
    )
    problem = ss.Problem(
        body, law, pull_rate=292260.8108363296, initial_load=-12320381.309406957, initial_state=0.06622406381951987
    )
    run = ss.simulate(problem, 0.01, rtol=1e-6)
    assert run.status.ok
    slope = body.impedance * problem.pull_rate / (0.5 * body.two_way_time)
    crossing = -problem.load / slope
    assert float(run.slip_rate(0.99 * crossing)) < 0.0 < float(run.slip_rate(1.01 * crossing))
    assert float(run.slip_rate(0.01) * body.impedance + run.traction(0.01)) == pytest.approx(problem.load + 0.01 * slope, rel=1e-12)


def test_falling_load_passes_over_a_branch_that_the_rule_never_takes() -> None:
    """Under the minimal rule the middle branch is never taken: the contact goes from the fast one to the slow one."""
    body = ss.ElasticSlab(280.5735681008616, 326.78595166755167, 296684611.70067954, 1154471.1949850072, 11312.608323952774)
    law = F.PiecewiseLinearRate(
        rates=(0.0005444392168457124, 0.0016360787040693666, 0.0351653901835378, 0.058667215230216854, 0.3627881149994565),
        coefficients=(1.1552101286726193, 0.2612825617357899, 1.0895333242228873, 0.945547357259521, 0.736759235352995),
    )
    problem = ss.Problem(
        body, law, pull_rate=26.300901079177258, initial_excess=0.0, far_stress=425205.0481968534, selection="minimal"
    )
    run = ss.simulate(problem, 9825321.71203126, rtol=1e-4, max_pieces=2000)
    assert run.status.ok
    falls = run.shocks[(run.shocks.cause == "fold") & (run.shocks.rate_before > 1.0)]
    assert len(falls) == 2  # in the second and third round trip
    assert (falls.rate_after <= law.rates[0] * (1.0 + 1e-9)).all()


def test_heat_is_finite_where_the_lag_falls_below_zero_by_its_tolerance() -> None:
    """ln(1 + w / 1e-6) is no number there, and with a = 0 its factor does not help."""
    body = ss.SpringBlock(6.0338482826876305, 1903.36748807836, 263507.5640525847, damping=321.4991070646787)
    rate = F.VelocityStrengthening(static=0.22749410856647856, a=0.0, rate=1e-6)
    law = F.LaggedFriction(rate=rate, time=0.058058076804999616, direct=0.009130399137237242, direct_rate=55.669589994872844)
    problem = ss.Problem(body, law, pull_rate=-39.490734181033055, initial_excess=-23.363714691738107)
    run = ss.simulate(problem, 58.7755515040617, rtol=1e-4)
    energy = run.energy([2.0, 20.0, 58.0])
    assert (energy.heat > 0.0).all()
    assert float(abs(energy.balance).max()) < 1e-3 * float(abs(energy.work).max())


def slip_law_slab() -> ss.Problem:
    """A slab under the slip law: in every round trip its load passes through zero, where ln(v) has no value."""
    body = ss.ElasticSlab(23709.441406605696, 23339.680523684852, 0.0007852679836914634, 4081910883.9803605, 0.0)
    law = F.RateAndState(
        reference=0.5841133946528673,
        a=1.1362620578071376,
        b=0.19711026208566498,
        distance=6.443972652480687e-07,
        rate=1.3577388126198202,
        evolution="slip",
    )
    return ss.Problem(body, law, pull_rate=64.73608214170346, initial_load=-2e8, initial_state=1e-6)


def test_passages_through_zero_under_the_slip_law_take_few_steps() -> None:
    """A step for each factor of the slip rate up to 1e-20 m/s would come back with every echo: hundreds of pieces a round trip."""
    problem = slip_law_slab()
    run = ss.simulate(problem, 20.0 * problem.body.two_way_time)
    assert run.status.ok
    assert len(run.history) < 20 * 250
    times = np.linspace(0.0, run.history.duration, 200)
    assert abs(problem.body.impedance * run.slip_rate(times) + run.traction(times) - run.load(times)).max() < 1e-12 * problem.normal
    passed = np.flatnonzero(np.diff(np.sign(run.load(times))))
    assert len(passed) >= 1
    assert (np.sign(run.slip_rate(times)) == np.sign(run.load(times))).all()


def test_load_near_zero_is_known_to_the_rounding_of_its_terms() -> None:
    """A load of 2e7 Pa turns within the first round trip; what is left of it where it turns, 1e-11 Pa, is rounding and not load."""
    body = ss.ElasticSlab(4421.29926180384, 2803.9499060079293, 1.677094721625349, 19804114.160770167, 6279861.323143668)
    law = F.RateAndState(
        reference=0.0003095064529503739,
        a=0.3082892723807372,
        b=0.08282823765499613,
        distance=0.0004165091945927362,
        evolution="slip",
    )
    problem = ss.Problem(
        body,
        law,
        pull_rate=0.1525239317168653,
        initial_slip=-0.0004271376177332445,
        initial_load=-764783.915102646,
        initial_state=0.002317648286021541,
        far_stress=19400585.135492798,
    )
    assert ss.simulate(problem, 0.0011959672471104515).status.ok


def test_block_that_oscillates_in_picoseconds_meets_every_step_of_its_loading() -> None:
    """The load is K (pull - slip). Steps of the loading 1e-9 s apart were taken for one: a row of the history was a day long."""
    block = ss.SpringBlock(4.5e-4, 1.24e15, 1.6e9)
    law = F.RateAndState(reference=0.69, a=0.64, b=0.84, distance=6.6e-5)
    steps = ss.loading.Steps(times=(0.0, 9e-10, 1.7e-9, 4.4e-9), values=(-6e-4, -3e-3, 8e-4, 1e-3))
    problem = ss.Problem(block, law, pull_rate=steps, initial_load=-1.33e9, initial_state=0.0026)
    run = ss.simulate(problem, 1e-8)
    times = np.array([5e-10, 1.2e-9, 3e-9, 9e-9])
    pulled = np.interp(times, (0.0, 9e-10, 1.7e-9, 4.4e-9, 1e-8), np.cumsum([0.0, -5.4e-13, -2.4e-12, 2.16e-12, 5.6e-12]))
    assert run.load(times) == pytest.approx(-1.33e9 + block.stiffness * (pulled - run.slip(times)), rel=1e-13)


def test_run_ends_where_friction_falls_below_zero() -> None:
    """Nothing in the formula says that it ends at 7.5e4 m/s; a load 20 times the normal force takes the block there."""
    law = F.FromExpression("0.6 - 1.4*v/(v + 1e5)")
    run = ss.simulate(ss.Problem(ss.SpringBlock(1.0, 1.0, 1e5), law, initial_load=2e6), 1.0)
    assert run.status.name == "negative friction"
    last = float(run.slip_rate(run.history.duration))
    assert abs(float(law.coefficient(0.0, last))) <= 1e-9
    assert last == pytest.approx(7.5e4, rel=1e-6)
    slab = ss.Problem(ss.ElasticSlab(1e3, 1e3, 1.0, 1e8), law, initial_load=1e12)
    with pytest.raises(ss.InputError, match="below zero"):
        ss.simulate(slab, 1e-3)


@pytest.mark.parametrize("body", [ss.SpringBlock(1.0, 1e4, 10.0), ss.ElasticSlab(1e3, 1e3, 1.0, 1e6)], ids=["block", "slab"])
def test_run_ends_where_the_state_makes_friction_negative(body: ss.SpringBlock | ss.ElasticSlab) -> None:
    """After fast slip the lag still says "fast" where slip is slow: with a strong direct effect mu falls below zero."""
    rate = F.HyperbolicRate(static=0.6, dynamic=0.1, alpha=1e-3)
    law = F.LaggedFriction(rate=rate, time=1.0, direct=0.2, direct_rate=1e-3)
    problem = ss.Problem(body, law, initial_load=1e3 if isinstance(body, ss.SpringBlock) else 1e8)
    run = ss.simulate(problem, 0.1)
    assert run.status.name == "negative friction"
    state = run.state(np.linspace(0.0, run.history.duration, 500))
    rate_now = abs(run.slip_rate(np.linspace(0.0, run.history.duration, 500)))
    assert (law.coefficient(0.0, rate_now, state) >= 0.0).all()
    assert float(law.coefficient(0.0, 0.0, state[-1])) < 0.0


@pytest.mark.parametrize("direct", [0.0, 1e-3])
def test_slip_rate_that_decays_into_the_rounding_of_the_load_ends_no_run(direct: float) -> None:
    """Friction follows with a lag until it carries the load: the slip rate is then the difference of two large stresses."""
    rate = F.VelocityStrengthening(static=0.0124, a=1.0146, rate=1e-6, viscosity=0.0097)
    law = F.LaggedFriction(rate=rate, time=7e4, direct=direct, direct_rate=3.3e6)
    slab = ss.ElasticSlab(252.49, 379.84, 2e7, 3.86e9)
    run = ss.simulate(ss.Problem(slab, law, initial_excess=6e6), 5e5)
    assert run.status.ok
    times = np.geomspace(1e-6, 5e5, 100)
    assert abs(slab.impedance * run.slip_rate(times) + run.traction(times) - run.load(times)).max() < 1e-12 * run.load(0.0)


def test_run_under_extreme_friction_finishes_in_slip() -> None:
    """e^(reference / a) is 1e168 here, whose square is no number: the slope of the arcsinh was zero then."""
    law = F.RateAndState(reference=88.66, a=0.2289, b=1.7e-5, distance=0.418, evolution="prz")
    slab = ss.ElasticSlab(4094.2, 3396.9, 568495.0, 6450.26)
    problem = ss.Problem(slab, law, pull_rate=0.78, initial_load=-1502.0, initial_state=1.575)
    run = ss.simulate(problem, 300.0, rtol=1e-6)
    assert run.status.ok
    assert float(run.slip_rate(300.0)) > 0.0
