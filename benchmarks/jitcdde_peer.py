"""JiTCDDE: delay equations compiled to C, an embedded Runge-Kutta pair of order 3 with cubic history.

A slab's load is beta = Z v + S mu, so its echo needs the slip rate of one round trip ago: a neutral equation in the slip alone,
Z u'(t) = r [Z u'(t-R) - S mu(u(t-R))] + inflow - S mu(u(t)), for a contact that slips all the time and from t = R on. What it
starts from, the first round trip, is handed over from the reference.
"""

from __future__ import annotations

import warnings
from contextlib import chdir
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.problems import Case, Floats
from benchmarks.runner import Runner, UnavailableError
from stickslip.friction import SinusoidalSlip
from stickslip.problem import steady_inflow
from stickslip.problem.bodies import ElasticSlab
from stickslip.run.simulate import simulate

try:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import jitcdde
        import symengine
except ImportError:
    jitcdde = None

ANCHORS = 3001
"""Points of the past: enough for its cubic pieces to be more exact than the steps that follow."""


def runner(case: Case, tolerance: float) -> Runner:
    """The problem in JiTCDDE, from the end of the first round trip."""
    if jitcdde is None:
        raise UnavailableError("JiTCDDE is not installed: pip install 'stickslip[bench]'")
    problem, body, law = case.problem, case.problem.body, case.problem.friction
    if not isinstance(body, ElasticSlab) or not isinstance(law, SinusoidalSlip) or case.start != body.two_way_time:
        raise UnavailableError("only slabs with a slip law that slide on beyond the first round trip")
    delay = body.two_way_time
    first_round = simulate(problem, delay, 1e-13)
    past = np.sort([*np.linspace(0.0, delay, ANCHORS), 0.5 * delay * (1.0 - 1e-9)])  # the slip rate jumps at h/c
    rates = np.append(first_round.slip_rate(past[:-1]), first_round.slip_rate(delay, side="left"))
    anchors = list(zip(past, first_round.slip(past), rates, strict=True))
    # max_delay: as long as the run, so that all of its history is kept for `slip`
    solver = jitcdde.jitcdde([_slip_rate(case)], delays=[0.0, delay], max_delay=2.0 * case.duration, verbose=False)
    with TemporaryDirectory() as folder, chdir(folder):  # it runs setuptools, which would read our pyproject.toml
        solver.compile_C(extra_compile_args=["-O3", "-march=native", "-w"])
        solver._tmpdir.cleanup()  # it is loaded by now; left to the end of the interpreter it warns
    ends = np.arange(2.0, 1.0 + round(case.duration / delay)) * delay

    def before() -> None:
        solver.purge_past()
        for t, u, v in anchors:
            solver.add_past_point(t, [u], [v])
        solver.set_integration_parameters(rtol=tolerance, atol=tolerance, first_step=1e-3, max_step=1.0, min_step=1e-12)
        solver.adjust_diff()

    def run() -> None:
        for end in ends:
            solver.integrate(end)
            solver.adjust_diff()  # the slip rate jumps at every echo of the start

    def slip(times: Floats) -> Floats:
        return np.asarray(solver.get_state().get_state(times)[:, 0] - problem.initial_slip)

    def steps() -> int:
        return sum(anchor.time > delay for anchor in solver.get_state())

    return Runner(case, tolerance, run, slip, steps, before=before)


def _slip_rate(case: Case):  # type: ignore[no-untyped-def]
    """u'(t) as an expression in u(t), u(t-R) and u'(t-R)."""
    problem, body, law = case.problem, case.problem.body, case.problem.friction
    Z, S, r, delay = body.impedance, body.normal_stress, body.reflection, body.two_way_time
    steady = steady_inflow(problem)[0] + (1.0 + r) * problem.strength

    def friction(u):  # type: ignore[no-untyped-def]
        return law.mean + law.amplitude * symengine.sin(law.wavenumber * u)

    before = jitcdde.t - delay
    echo = r * (Z * jitcdde.dy(0, before) - S * friction(jitcdde.y(0, before)))
    return (echo + steady - S * friction(jitcdde.y(0))) / Z
