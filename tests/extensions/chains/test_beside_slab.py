"""A chain with friction under its first block becomes the slab, at orders that are known, and a shock becomes Airy's front."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.chains.beside_slab import AIRY_PEAK, AIRY_WIDTH, ChainBesideSlab

SLAB = ss.ElasticSlab(density=1.0, wave_speed=1.0, thickness=1.0, normal_stress=1.0)
WEAKENING = ss.friction.LinearSlipWeakening(static=0.8, dynamic=0.3, distance=0.2)
DRY = ss.friction.Coulomb(static=0.8, dynamic=0.3)


def problem(law: Any = WEAKENING, **given: Any) -> ss.Problem:
    return ss.Problem(SLAB, law, **{"pull_rate": 0.01, "initial_excess": 0.0} | given)


@cache
def smooth() -> ChainBesideSlab:
    """Return the study of slip weakening: over the first event and into the rest after it."""
    return ss.studies.chain_beside_slab(problem(), 4.0, (32, 64, 128))


@cache
def with_shock() -> ChainBesideSlab:
    """Return the study of Coulomb's friction, which begins to slip with a shock."""
    return ss.studies.chain_beside_slab(problem(DRY), 1.9, (64, 256))


def test_with_half_a_mass_at_the_contact_slip_is_approached_at_order_two() -> None:
    found = smooth()
    assert found.table[found.table.first_block == "half"].order.iloc[1:].to_numpy() == pytest.approx([2.0, 2.0], rel=0.0, abs=0.01)
    assert found.table.difference.min() < 1e-4 * float(found.slab.slip(4.0))


def test_with_equal_masses_at_order_one_as_the_contact_carries_half_a_block() -> None:
    found = smooth()
    whole = found.table[found.table.first_block == "whole"]
    assert whole.order.iloc[-1] == pytest.approx(1.0, rel=0.0, abs=0.02)
    assert whole.order_with_mass.iloc[-1] == pytest.approx(2.0, rel=0.0, abs=0.06)
    assert (whole.difference_with_mass < 0.03 * whole.difference).all()


def test_slip_at_any_time_is_that_of_the_slab() -> None:
    found, times = smooth(), np.linspace(0.0, 4.0, 37)
    assert found.slip(128, "half", times) == pytest.approx(found.slab.slip(times), rel=0.0, abs=7e-5)
    assert float(found.slab.slip(4.0)) > 0.9


def test_a_shock_becomes_the_front_of_airy() -> None:
    """Its width falls as n^(-2/3); its overshoot, that of the integral of Airy's function, stays."""
    table = with_shock().table
    last = table[table.blocks == 256]
    assert last.front.to_numpy() == pytest.approx(last.airy_front.to_numpy(), rel=0.015, abs=0.0)
    assert last.peak.to_numpy() == pytest.approx(AIRY_PEAK, rel=0.01, abs=0.0)
    for first in ("half", "whole"):
        front = table[table.first_block == first].front
        assert math.log(front.iloc[0] / front.iloc[1]) / math.log(4.0) == pytest.approx(2.0 / 3.0, rel=0.03, abs=0.0)
    assert "Airy's front" in with_shock().front_text
    assert smooth().front_text == ""


def test_under_the_rate_law_a_shock_is_as_wide_and_slip_is_approached() -> None:
    """Law (15) with twice its critical alpha: the contact jumps when slip begins. A front that stays below 0.9 has no width."""
    rate_law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=4.0)
    table = ss.studies.chain_beside_slab(problem(rate_law), 1.9, (16, 32, 64)).table
    half, whole = (table[table.first_block == one] for one in ("half", "whole"))
    assert half.front.to_numpy() == pytest.approx(half.airy_front.to_numpy(), rel=0.02, abs=0.0)
    assert whole.peak.iloc[0] < 0.9
    assert math.isnan(whole.front.iloc[0])
    assert (half.order.iloc[1:] > 0.5).all()
    assert (whole.order.iloc[1:] > 0.8).all()


def test_a_smooth_law_of_slip_is_approached_at_the_same_orders() -> None:
    """Law (14), from a slip where it weakens."""
    law = ss.friction.SinusoidalSlip(0.6, 0.2, 10.0)
    found = ss.studies.chain_beside_slab(problem(law, initial_slip=0.157), 1.9, (32, 64))
    assert found.last_order("half") == pytest.approx(2.0, rel=0.0, abs=0.4)
    assert found.last_order("whole") == pytest.approx(1.0, rel=0.0, abs=0.02)


@pytest.mark.slow
def test_the_numbers_of_airys_front() -> None:
    from mpmath import airyai, findroot, mp, quad

    def risen(s: float) -> Any:
        return quad(airyai, [-s, 0, mp.inf]) if s > 0 else quad(airyai, [-s, mp.inf])

    ends = [findroot(lambda s, level=level: risen(s) - level, near) for level, near in ((0.1, -1.0), (0.9, 1.2))]
    assert float(ends[1] - ends[0]) == pytest.approx(AIRY_WIDTH, rel=1e-6, abs=0.0)
    assert float(risen(2.338107410459767)) == pytest.approx(AIRY_PEAK, rel=1e-6, abs=0.0)


def test_units_do_not_matter() -> None:
    """The same slab, as large and as stiff as rock: times of a second become h/c, lengths S h/G."""
    rock = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
    length, time = rock.normal_stress * rock.thickness / rock.shear_modulus, rock.thickness / rock.wave_speed
    law = replace(WEAKENING, distance=0.2 * length)
    found = ss.studies.chain_beside_slab(
        ss.Problem(rock, law, pull_rate=0.01 * length / time, initial_excess=0.0), 4.0 * time, (32, 64)
    )
    here = smooth().table[:4]
    assert found.table.difference.to_numpy() / length == pytest.approx(here.difference.to_numpy(), rel=1e-6, abs=0.0)


def test_the_start_of_a_law_of_slip_is_that_of_the_problem() -> None:
    """After 0.1 m of slip half of the weakening is over, and the contact rests at its strength there."""
    found = ss.studies.chain_beside_slab(problem(initial_slip=0.1), 3.0, (32, 64))
    assert found.last_order("half") == pytest.approx(2.0, rel=0.0, abs=0.1)


REFUSED: list[tuple[Any, tuple[Any, ...], str]] = [
    (
        ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), DRY, pull_rate=0.1, initial_load=0.0),
        (1.0,),
        "needs an ElasticSlab under a rigid driver",
    ),
    (replace(problem(), body=replace(SLAB, contact_mass=0.1)), (1.0,), "whose contact has no mass"),
    (replace(problem(), body=replace(SLAB, driver_impedance=1.0)), (1.0,), "under a rigid driver"),
    (problem(), (1.0, (16,)), "blocks must be two or more numbers, such as (16, 32, 64), got"),
    (problem(), (1.0, (32, 16)), "blocks must ascend, got 32, 16"),
    (problem(), (1.0, (2, 16)), "blocks must be a whole number from 4 to 4096"),
    (problem(initial_excess=-0.5), (1.0,), "the contact of the slab does not slip within 1 s: take a longer duration"),
    (problem(), (1e5,), "duration must be at most 1000 round trips, 2000 s, got 100000 s"),
]


@pytest.mark.parametrize(("given", "rest", "message"), REFUSED)
def test_what_cannot_be_compared_is_refused_in_one_line(given: Any, rest: tuple[Any, ...], message: str) -> None:
    with pytest.raises(ss.InputError) as error:
        ss.studies.chain_beside_slab(given, *rest)
    assert str(error.value).startswith("chain_beside_slab: ")
    assert message in str(error.value)
    assert "\n" not in str(error.value)
