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
