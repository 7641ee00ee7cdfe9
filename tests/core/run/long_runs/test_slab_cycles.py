"""Cycles of a slab that heals at every arrest: creep at the crest of a wave, and the events of slabs whose waves may leave."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss

LAW = ss.friction.LinearSlipWeakening(0.677, 0.525, 0.4, memory="since-arrest")
SLAB = ss.ElasticSlab(2800, 3500, 1e4, 120e6, contact_mass=1e5)
PLATE = 0.05 / ss.YEAR


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("share", "years"), [(1.0, 278.2014), (10.0, 208.8326)])
def test_a_driver_that_takes_up_waves_gives_one_event_after_the_other(share: float, years: float) -> None:
    """Equal events, each of the slip that the driver has moved since the last; the energy balance closes to 1e-10 of the heat."""
    body = replace(SLAB, driver_impedance=share * SLAB.impedance, driver_integral_gain=share * SLAB.stiffness)
    run = ss.simulate(ss.Problem(body, LAW, pull_rate=PLATE, initial_excess=0.0), "900 years")
    assert run.status.name == "finished"
    between = run.events.start.diff().to_numpy()[1:]
    assert len(between) >= 3
    assert between / ss.YEAR == pytest.approx(years, rel=1e-6)
    assert run.events.slip.to_numpy()[1:] == pytest.approx(PLATE * between, rel=1e-5)
    energy = run.energy(run.duration)
    assert abs(energy.balance.item()) < 1e-10 * energy.heat.item()


def test_under_a_rigid_driver_the_crest_of_a_wave_creeps_and_every_round_trip_has_two_more_pieces() -> None:
    run = ss.simulate(ss.Problem(SLAB, LAW, pull_rate=PLATE, initial_excess=0.0), "400 years", max_pieces=20_000)
    assert run.status.name == "too many pieces"
    assert "111.186 years of 400 years" in run.status.message
    assert "driver_integral_gain" in run.status.message
    assert len(run.events) == 1
    counts = np.unique(run.history.store.trip, return_counts=True)[1]
    assert set(np.diff(counts[4:-1]).tolist()) == {2}
    creep_from = 111.1 * ss.YEAR
    assert float(run.slip(run.duration) - run.slip(creep_from)) < 100 * PLATE * SLAB.two_way_time


def test_pulled_fast_enough_the_same_slab_has_events_under_a_rigid_driver() -> None:
    """At 3 cm/s, nearly half of the weakening distance in a round trip: one event of 10 m for each 10.5 m of pull."""
    pull, distance = 1e6 / ss.YEAR, 10.5
    run = ss.simulate(ss.Problem(SLAB, LAW, pull_rate=pull, initial_excess=0.0), 5.5 * distance / pull)
    large = run.events[run.events.slip > 1.0]
    assert len(large) == 6
    assert large.start.diff().mean() * pull == pytest.approx(distance, rel=0.05)


def test_a_catalogue_does_not_advise_a_catalogue() -> None:
    table = ss.catalogue(ss.Problem(SLAB, LAW, pull_rate=PLATE, initial_excess=0.0), "400 years", max_pieces=2000)
    assert table.attrs["status"] == "too many pieces"
    assert "catalogue" not in table.attrs["status_message"]
