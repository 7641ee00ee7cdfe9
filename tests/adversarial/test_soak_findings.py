"""What the soak found: each a small problem that ended wrongly, or not at all, until it was mended."""

from __future__ import annotations

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


def test_events_of_slip_rates_that_decay_to_nothing_are_told() -> None:
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


def test_load_that_passes_through_zero_early_in_a_long_stretch_turns_the_contact() -> None:
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
