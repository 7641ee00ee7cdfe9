"""Compare a few short runs of the engine with closed forms."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

from stickslip.cli.installation import Finding

AGREE = 1e-9
"""Largest relative difference between an answer of the engine and its closed form."""


class Trial(NamedTuple):
    """One answer of the engine, with the number that it must be."""

    name: str
    answer: float
    exact: float
    unit: str


def self_test() -> Iterator[Finding]:
    """Yield a row for each closed form with which a run is compared, and the time. A run that cannot be made is a fault."""
    begun = time.perf_counter()
    for trial in TRIALS:
        try:
            yield judged(trial())
        except Exception as error:  # whatever a broken library raises is what the user has to know
            said = " ".join(f"{type(error).__name__}: {error}".split())
            yield Finding("self-test", "failed", f"the engine cannot run ({said}): pip install --force-reinstall stickslip")
            return
    yield Finding("self-test", f"took {time.perf_counter() - begun:.1f} s")


def judged(trial: Trial) -> Finding:
    """Return the row of an answer; one that differs from the closed form is a fault."""
    name, answer, exact, unit = trial
    off = abs(answer / exact - 1.0)
    shown = f"{name} {answer:.10g} {unit}, closed form {exact:.10g} {unit}"
    if off <= AGREE:
        return Finding("self-test", shown)
    cure = "remove the cache, and run it again; if it stays, please report it with all of these lines"
    return Finding("self-test", shown, f"{shown}: {cure}")


def _block() -> Trial:
    """Slip of one event of the block under Coulomb friction: half a swing, u = 2 (muS - muD) S / K without pull."""
    import stickslip as ss
    from stickslip.reference.block import CoulombBlock

    body = ss.SpringBlock(2.8e12, 3.43e13, normal_force=1e14)
    exact = CoulombBlock(body, 0.8, 0.3, pull_rate=0.3)
    run = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.8, 0.3), pull_rate=0.3, initial_excess=0.0), 1.5 * exact.duration)
    return Trial("slip of a block", float(run.slip(exact.duration)), exact.total_slip, "m")


def _slab_under_rate_law() -> Trial:
    """Slip rate of the slab of Figure 6 right after the onset: v = (muS - muD) S / Z - 1 / alpha."""
    import stickslip as ss

    run = ss.simulate("fig6-slab", 1.0)
    drop, impedance, alpha = 0.5 * 100e6, 2800.0 * 3500.0, 1.0
    return Trial("slip rate of a slab", float(run.slip_rate(0.0)), drop / impedance - 1.0 / alpha, "m/s")


def _slab_under_slip_law() -> Trial:
    """Slip within one pulse of a slab under the sinusoidal slip law: 2 pi / omega in the period of the closed form."""
    import stickslip as ss
    from stickslip.reference.slab.pulse_period import PulseTrain

    body = ss.ElasticSlab(2800.0, 3500.0, 10e3, normal_stress=100e6)
    law = ss.friction.SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=5.0)
    problem = ss.Problem(body, law, pull_rate=0.0, initial_excess=60e6)
    period = PulseTrain(body.impedance, problem.load, problem.normal, 1.0, 0.5, 5.0).period
    run = ss.simulate(problem, period)
    return Trial("slip in a pulse of a slab", float(run.slip(period)), 2.0 * math.pi / 5.0, "m")


TRIALS: tuple[Callable[[], Trial], ...] = (_block, _slab_under_rate_law, _slab_under_slip_law)
"""The comparisons, in the order in which they are made."""
