"""The balance of energy of each scheme: it closes to rounding, and tends to that of the exact slab."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.schemes.contract import Sample, Series
from stickslip.extensions.schemes.run import SCHEMES, run_scheme
from stickslip.extensions.schemes.schemes import schemes

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
SMOOTH = ss.Problem(SLAB, ss.friction.SinusoidalSlip(1.0, 0.5, 2.0), pull_rate=0.3, initial_slip=np.pi / 4, initial_excess=0.0)
LOOP = ss.load_scenario("fig4-loop").problem
FAST = replace(ss.load_scenario("fig6-slab").problem, pull_rate=0.5)
UNDAMPED = ("characteristics", "central-differences", "central-differences-cfl1", "mass-redistribution", "newmark", "regularised")
"""Schemes that conserve the energy that they count, by their formulas."""
SOFT = replace(LOOP, body=replace(SLAB, driver_impedance=4e6), far_stress=6.5e7)
CASES = {"smooth": (SMOOTH, 4.0), "shocks and rest": (FAST, 12.0), "a driver that gives way": (SOFT, 5.7)}


def balance(series: Series) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Return stored + friction + damped - driver, which has to be constant."""
    assert series.energies is not None
    return series.energies @ np.array([1.0, -1.0, 1.0, 1.0])


@pytest.mark.sampled(every=36)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("name", SCHEMES)
def test_each_scheme_balances_its_own_energy_to_rounding(name: str, case: str) -> None:
    problem, duration = CASES[case]
    for search in ("stick-first", "continue"):
        series = run_scheme(problem, duration, SCHEMES[name], 40, search=search)
        assert series.energies is not None
        left = balance(series)
        assert np.abs(left - left[0]).max() < 1e-12 * series.energies[-1, 2]
        damped = series.energies[:, 3]
        if name in UNDAMPED:
            assert not damped.any()
        else:
            assert (np.diff(damped) > -1e-15 * series.energies[-1, 2]).all()
            assert damped[-1] > 0.0


@pytest.mark.sampled(every=12)
@pytest.mark.parametrize("name", SCHEMES)
def test_the_heat_of_each_scheme_tends_to_that_of_the_exact_slab(name: str) -> None:
    regularised = name == "regularised"
    table = schemes(SMOOTH, 4.0, name, [80, 160]).table
    coarse, fine = table.heat_error.abs()
    assert fine < 0.03
    assert fine < (1.0 if regularised else 0.6) * coarse
    assert (table.energy_drift.abs() < 1e-12).all()


def test_energies_that_a_scheme_does_not_count_are_unknown() -> None:
    own = SCHEMES["characteristics"]

    class Silent:
        name, title, order, courant, largest_courant = "silent", "counts no energy", 2.0, 1.0, 1.0

        def begin(self, grid):  # type: ignore[no-untyped-def]
            motion = own.begin(grid)

            class Motion:
                def first(self, contact) -> Sample:  # type: ignore[no-untyped-def]
                    return motion.first(contact)._replace(energies=None)

                def advance(self, contact) -> Sample:  # type: ignore[no-untyped-def]
                    return motion.advance(contact)._replace(energies=None)

            return Motion()

    row = schemes(SMOOTH, 4.0, Silent(), [100]).table.iloc[0]
    assert np.isnan([row.stored, row.damped, row.energy_drift]).all()
    assert abs(row.heat_error) < 0.01
