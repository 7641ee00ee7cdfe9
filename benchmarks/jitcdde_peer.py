"""JiTCDDE: delay equations compiled to C, an embedded Runge-Kutta pair of order 3 with cubic history.

A slab's load is beta = Z v + S mu, so its echo needs the slip rate of one round trip ago: a neutral equation in the slip alone,
Z u'(t) = r [Z u'(t-R) - S mu(u(t-R))] + inflow - S mu(u(t)), for a contact that slips all the time and from t = R on. What it
starts from, the first round trip, is handed over from the reference.
"""

from __future__ import annotations

import warnings
from contextlib import chdir
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.problems import Case, Floats
from benchmarks.runner import Runner, Unavailable
from stickslip.bodies import ElasticSlab
from stickslip.evolution.setup import inflow
from stickslip.evolution.simulate import simulate
from stickslip.friction import SinusoidalSlip

try:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import jitcdde
        import symengine
except ImportError:
    jitcdde = None

ANCHORS = 3000
"""Points of the past: enough for its cubic pieces to be more exact than the steps that follow."""


def runner(case: Case, tolerance: float) -> Runner:
    """The problem in JiTCDDE, from the end of the first round trip."""
    if jitcdde is None:
        raise Unavailable("JiTCDDE is not installed: pip install 'stickslip[bench]'")
    problem, body, law = case.problem, case.problem.body, case.problem.friction
    if not isinstance(body, ElasticSlab) or not isinstance(law, SinusoidalSlip) or case.start != body.two_way_time:
        raise Unavailable("jitcdde_peer: slabs with a slip law that slide on beyond the first round trip")
    delay = body.two_way_time
    first_round = simulate(problem, delay, 1e-13)
    past = np.linspace(0.0, delay, ANCHORS)
    anchors = list(zip(past, first_round.slip(past), first_round.slip_rate(past, side="left"), strict=True))
    solver = jitcdde.jitcdde([_slip_rate(case)], delays=[0.0, delay], max_delay=1.01 * delay, verbose=False)
    with TemporaryDirectory() as folder, chdir(folder):  # it runs setuptools, which would read our pyproject.toml
        solver.compile_C(extra_compile_args=["-O3", "-march=native", "-w"])
    ends = np.arange(2.0, 1.0 + round(case.duration / delay)) * delay
    splines: list[Any] = []

    def before() -> None:
        solver.purge_past()
        for t, u, v in anchors:
            solver.add_past_point(t, [u], [v])
        solver.set_integration_parameters(rtol=tolerance, atol=tolerance, first_step=1e-3, max_step=1.0, min_step=1e-12)

    def run() -> None:
        splines.clear()
        for end in ends:
            solver.adjust_diff()  # the slip rate jumps at every echo of the start
            solver.integrate(end)
            splines.append(solver.get_state())

    def slip(times: Floats) -> Floats:
        rounds = np.minimum(np.searchsorted(ends, times), len(ends) - 1)
        values = np.array([splines[n].get_state(t)[0] for n, t in zip(rounds, times, strict=True)])
        return np.asarray(values - problem.initial_slip)

    def steps() -> int:
        return sum(sum(anchor.time > end - delay for anchor in spline) for spline, end in zip(splines, ends, strict=True))

    return Runner(case, tolerance, run, slip, steps, before=before)


def _slip_rate(case: Case):  # type: ignore[no-untyped-def]
    """u'(t) as an expression in u(t), u(t-R) and u'(t-R)."""
    problem, body, law = case.problem, case.problem.body, case.problem.friction
    Z, S, r, delay = body.impedance, body.normal_stress, body.reflection, body.two_way_time
    steady = inflow(problem)[0] + (1.0 + r) * problem.strength

    def friction(u):  # type: ignore[no-untyped-def]
        return law.mean + law.amplitude * symengine.sin(law.wavenumber * u)

    before = jitcdde.t - delay
    echo = r * (Z * jitcdde.dy(0, before) - S * friction(jitcdde.y(0, before)))
    return (echo + steady - S * friction(jitcdde.y(0))) / Z
