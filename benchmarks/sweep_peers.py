"""Who else runs many members: the same algorithm in C with OpenMP, a loop over scipy, heyoka's SIMD lanes, diffrax vmapped.

Each peer is a function of a task that gives a runner; the runner runs all members on so many threads and returns their slips (m).
What it takes to get ready (compilation, solvers, for C the setups too) is not counted.
"""

from __future__ import annotations

import copy
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np

from benchmarks import c_peer, scipy_peer
from benchmarks.problems import ROUND, Case, Floats
from benchmarks.runner import UnavailableError
from stickslip.engine.lanes.runs import Group, engine_address, run_group
from stickslip.engine.lanes.setups import set_up
from stickslip.engine.lanes.vectorised_problem import member
from stickslip.engine.lanes.workspace import new_workspace, table_of
from stickslip.extensions.sweeps.batch import QUANTITIES, run_members
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH
from stickslip.friction import SinusoidalSlip
from stickslip.problem.bodies import ElasticSlab
from stickslip.problem.scenarios.scenario import Scenario

try:
    import heyoka
except ImportError:
    heyoka = None

Run = Callable[[int], Floats]


@dataclass(frozen=True)
class Task:
    """Members to run: a problem of the benchmarks, one key of it that varies, and its numbers."""

    title: str
    case: Case
    rtol: float
    key: str
    ends: tuple[float, float]
    more: int = 1
    """Times as many members as asked for: a thread is to have work for a tenth of a second."""

    @property
    def scenario(self) -> Scenario:
        """The scenario whose members are run."""
        return Scenario(self.case.problem, self.case.duration, self.rtol)

    def numbers(self, members: int) -> Floats:
        """Of the key, for so many members."""
        return np.linspace(*self.ends, members)


def ours(task: Task, members: int, quantities: tuple[str, ...] = ("slip",)) -> Run:
    """A batch, its set-up counted."""
    values = {task.key: task.numbers(members)}
    return lambda threads: run_members(task.scenario, values, quantities, threads).results["slip"]


def setups_given(task: Task, members: int) -> Run:
    """The batch's kernel alone, on one thread: as C, it gets the setups as a gift."""
    setups = set_up(task.scenario, {task.key: task.numbers(members)})
    work = new_workspace().ready_for(setups.constants.shape[2])
    base, stride = table_of(setups, work)
    codes, out, stop = np.empty(members, np.int64), np.empty((members, len(QUANTITIES))), np.zeros(1, np.int64)

    def run(threads: int) -> Floats:
        work.upcoming[:] = 0
        assert run_group(Group(engine_address(), setups, False, stop, codes, out), base, stride, work) == SIMD_WIDTH
        return out[:, QUANTITIES.index("slip")]

    return run


def all_quantities(task: Task, members: int) -> Run:
    """A batch that folds each run into everything it knows."""
    return ours(task, members, QUANTITIES)


def in_c(task: Task, members: int) -> Run:
    """The engine's algorithm in C; it gets the members' setups as a gift."""
    law = task.case.problem.friction
    (formula,) = law.trees()
    kernel = c_peer.library(formula, law.parameters()).run_members
    setups = set_up(task.scenario, {task.key: task.numbers(members)})
    work = new_workspace().ready_for(setups.constants.shape[2])
    base, stride = table_of(setups, work)
    kept = (setups, work)
    lent = (base, stride, work.table, setups.params)
    given = (setups.branches, setups.state, setups.counts, setups.last_trip, setups.last_phase)

    def run(threads: int) -> Floats:
        slip = np.empty(members)
        assert kept
        pointers = [array.ctypes.data for array in (*lent, *given)]
        failed = kernel(*pointers[:4], int(len(setups.params) > 1), *pointers[4:], members, threads, slip.ctypes.data)
        assert failed == 0, f"{failed} members in C did not finish"
        return slip

    return run


def in_scipy(task: Task, members: int) -> Run:
    """scipy's DOP853 in a loop; threads do not help it."""
    scenarios = [member(task.scenario, {task.key: float(x)}) for x in task.numbers(members)]
    runners = [scipy_peer.runner(replace(task.case, problem=one.problem), task.rtol) for one in scenarios]

    def run(threads: int) -> Floats:
        for runner in runners:
            runner.run()
        end = ROUND * round(task.case.duration / ROUND)  # it rests from there on; the block is asked for its last slip
        return np.array([runner.slip(np.array([end]))[0] for runner in runners])

    return run


# ---- heyoka -----------------------------------------------------------------------------------------------------------------


def in_heyoka(task: Task, members: int) -> Run:
    """Lanes of members side by side in SIMD registers, a solver for each thread. The load at the start varies, as a parameter."""
    if heyoka is None:
        raise UnavailableError("heyoka is not installed: pip install 'stickslip[bench]' (Linux only)")
    body = task.case.problem.body
    if not isinstance(task.case.problem.friction, SinusoidalSlip):
        raise UnavailableError("slip rates that are roots of an equation are none of heyoka's business")
    if isinstance(body, ElasticSlab) and task.case.duration > body.two_way_time:
        raise UnavailableError("heyoka has no delays")
    lanes = heyoka.recommended_simd_size()
    loads = _loads(task, -(-members // lanes) * lanes).reshape(-1, lanes)
    pattern = _slab_lanes(task, lanes) if isinstance(body, ElasticSlab) else _block_lanes(task, lanes)
    solvers = [(copy.deepcopy(pattern[0]), pattern[1]) for _ in range(16)]

    def share(solver: tuple[object, Callable[..., Floats]], rows: Floats) -> Floats:
        taylor, solve = solver
        return np.array([solve(taylor, row) for row in rows])

    def run(threads: int) -> Floats:
        parts = np.array_split(loads, threads)
        if threads == 1:
            return share(solvers[0], parts[0]).ravel()[:members]
        with ThreadPoolExecutor(threads) as pool:
            return np.concatenate(list(pool.map(share, solvers, parts))).ravel()[:members]

    return run


def _loads(task: Task, members: int) -> Floats:
    numbers, start = task.numbers(members), task.case.problem
    return numbers if task.key == "initial.load" else start.strength + numbers


def _slab_lanes(task: Task, lanes: int) -> tuple[object, Callable[..., Floats]]:
    problem, body, law = task.case.problem, task.case.problem.body, task.case.problem.friction
    assert isinstance(body, ElasticSlab)
    assert isinstance(law, SinusoidalSlip)
    u = heyoka.make_vars("u")
    load = heyoka.par[0] + body.impedance * problem.pull_rate / (0.5 * body.two_way_time) * heyoka.time
    friction = law.mean + law.amplitude * heyoka.sin(law.wavenumber * u)
    motion = [(u, (load - body.normal_stress * friction) / body.impedance)]
    start = np.full((1, lanes), problem.initial_slip)
    taylor = heyoka.taylor_adaptive_batch(motion, start, tol=task.rtol, pars=np.zeros((1, lanes)))
    zero, end = np.zeros(lanes), np.full(lanes, task.case.duration)

    def solve(taylor: object, loads: Floats) -> Floats:
        taylor.set_time(zero)  # type: ignore[attr-defined] # heyoka
        taylor.state[:], taylor.pars[0] = start, loads  # type: ignore[attr-defined]
        taylor.propagate_until(end)  # type: ignore[attr-defined]
        return np.array(taylor.state[0] - problem.initial_slip)  # type: ignore[attr-defined]

    return taylor, solve


def _block_lanes(task: Task, lanes: int) -> tuple[object, Callable[..., Floats]]:
    problem, body, law = task.case.problem, task.case.problem.body, task.case.problem.friction
    assert not isinstance(body, ElasticSlab)
    assert isinstance(law, SinusoidalSlip)
    u, v = heyoka.make_vars("u", "v")
    spring = heyoka.par[0] + body.stiffness * (problem.pull_rate * heyoka.time - (u - problem.initial_slip))
    friction = body.normal_force * (law.mean + law.amplitude * heyoka.sin(law.wavenumber * u))
    arrest = heyoka.t_event_batch(v, direction=heyoka.event_direction.negative)
    start = np.stack([np.full(lanes, problem.initial_slip), np.zeros(lanes)])
    motion = [(u, v), (v, (spring - friction) / body.mass)]
    taylor = heyoka.taylor_adaptive_batch(motion, start, tol=task.rtol, pars=np.zeros((1, lanes)), t_events=[arrest])
    zero, end = np.zeros(lanes), np.full(lanes, task.case.duration)

    def solve(taylor: object, loads: Floats) -> Floats:
        taylor.set_time(zero)  # type: ignore[attr-defined] # heyoka
        taylor.state[:], taylor.pars[0] = start, loads  # type: ignore[attr-defined]
        taylor.reset_cooldowns()  # type: ignore[attr-defined]
        rests = np.zeros(lanes, bool)
        while not rests.all():  # one lane's event stops all: go on with the others
            taylor.propagate_until(np.where(rests, taylor.time, end))  # type: ignore[attr-defined]
            outcome = np.array([int(result[0]) for result in taylor.propagate_res])  # type: ignore[attr-defined]
            rests |= (outcome == -1) | (taylor.time >= end)  # type: ignore[attr-defined]
        return np.array(taylor.state[0] - problem.initial_slip)  # type: ignore[attr-defined]

    return taylor, solve


# ---- diffrax ----------------------------------------------------------------------------------------------------------------


def in_diffrax(task: Task, members: int) -> Run:
    """JAX: Dopri8 vmapped over members. First transit of a slip law: it has neither delays nor slip rates that are roots."""
    problem, body, law = task.case.problem, task.case.problem.body, task.case.problem.friction
    if not isinstance(body, ElasticSlab) or not isinstance(law, SinusoidalSlip) or task.case.duration > body.two_way_time:
        raise UnavailableError("no delays, and no slip rate that is the root of an equation")
    try:
        import diffrax
        import jax
    except ImportError:
        raise UnavailableError("diffrax is not installed") from None
    jax.config.update("jax_enable_x64", True)
    slope = body.impedance * problem.pull_rate / (0.5 * body.two_way_time)

    def rate(t, u, load):  # type: ignore[no-untyped-def]
        friction = body.normal_stress * (law.mean + law.amplitude * jax.numpy.sin(law.wavenumber * u))
        return (load + slope * t - friction) / body.impedance

    control = diffrax.PIDController(rtol=task.rtol, atol=1e-3 * task.rtol)

    def one(load):  # type: ignore[no-untyped-def]
        found = diffrax.diffeqsolve(
            diffrax.ODETerm(rate), diffrax.Dopri8(), 0.0, task.case.duration, None, problem.initial_slip, load,
            stepsize_controller=control, max_steps=10_000,
        )  # fmt: skip
        return found.ys[0] - problem.initial_slip

    solve, loads = jax.jit(jax.vmap(one)), jax.numpy.asarray(_loads(task, members))
    return lambda threads: np.asarray(solve(loads).block_until_ready())


PEERS: dict[str, Callable[[Task, int], Run]] = {
    "stickslip, slip": ours,
    "stickslip, its setups given": setups_given,
    "stickslip, 18 quantities": all_quantities,
    "C with OpenMP, its setups given": in_c,
    "scipy DOP853 in a loop": in_scipy,
    "heyoka, SIMD lanes": in_heyoka,
    "diffrax Dopri8, vmapped": in_diffrax,
}
ONE_THREAD = {"stickslip, its setups given", "scipy DOP853 in a loop", "diffrax Dopri8, vmapped"}
"""Peers for which threads are no option: scipy holds Python's lock, XLA decides by itself."""
ADAPTED = {"heyoka, SIMD lanes", "diffrax Dopri8, vmapped"}
"""Peers that get the loosest tolerance at which their error is like ours."""
FEWER = {"scipy DOP853 in a loop": 1000, "diffrax Dopri8, vmapped": 4}
"""By how much fewer members the slower ones get."""
