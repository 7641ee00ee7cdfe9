"""`python -m benchmarks.planar`: what a planar slab costs, beside the volume method, convolution over all history, and plain loops.

Processor times of one process, medians; the solver is compiled beforehand. The reference methods are numpy; so that their language
does not decide, the sums over waves that they cannot avoid are also timed as plain loops compiled by numba.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any
from unittest.mock import patch

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray
from tests.extensions.planar.convolution import convolution
from tests.extensions.planar.planar_methods import PlanarCase, SlipWeakeningAtNodes, volume

import stickslip as ss
from benchmarks.planar_kernels import NumbaSteps, convolved, exponentials, exponentials_in_c, lines_of_nodes
from stickslip.extensions.planar.memory import advanced
from stickslip.extensions.planar.solver import PlanarSolver, functions_of, our_settings

Floats = NDArray[np.float64]
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
ROUND = SLAB.two_way_time
LENGTH, NODES = 4e4, 512
LAW = ss.friction.LinearSlipWeakening(static=0.7, dynamic=0.5, distance=0.8)
TARGET, FINE = 1e-3, 4096
LADDER = (256, 322, 404, 512, 640, 800, 1024, 1280, 1600)
"""Numbers of steps in a round trip that are tried; 322 is the fewest that the solver accepts, 404 that convolution does."""
TRIPS = (1, 3, 10)


def load(y: Floats) -> Floats:
    """Return the load at the start (Pa): a peak above the strength in the middle of a fault that could slip by 6 m."""
    return np.asarray(60e6 + 12e6 * np.exp(-((y / 4e3) ** 2)))


def locked(y: Floats) -> NDArray[np.bool_]:
    return np.asarray(np.abs(y) > 15e3)


def case() -> PlanarCase:
    y = (np.arange(NODES) / NODES - 0.5) * LENGTH
    friction = SlipWeakeningAtNodes((NODES,), 70e6, 50e6, LAW.distance)
    return PlanarCase(2800.0, 3500.0, 1e4, (LENGTH,), load(y), friction, locked=locked(y))


class Ours:
    """The solver, compiled, which can be run again from the start."""

    def __init__(self, trips: int, steps: int) -> None:
        problem = ss.Problem(SLAB, LAW, initial_load=60e6)
        slab = ss.PlanarSlab(problem, nodes=NODES, length=LENGTH, along={"initial.load": load}, barrier=locked)
        self.solver = PlanarSolver(slab, trips * ROUND, steps_per_round_trip=steps)
        self.finish()

    def finish(self) -> list[tuple[float, float]]:
        """Run to the end; return for each round trip the processor time of its echo, with one step, and of its other steps."""
        found, solver = [], self.solver
        while True:
            begin = time.process_time()
            if not solver.advance(1):
                return found
            jax.block_until_ready(solver.waves)
            middle = time.process_time()
            solver.advance(solver.steps)
            jax.block_until_ready(solver.waves)
            found.append((middle - begin, time.process_time() - middle))

    def again(self) -> None:
        """Run once more, the set-up included."""
        self.solver.trip = self.solver.step = 0
        with our_settings():
            self.solver._begin()
        self.finish()

    def slip(self) -> Floats:
        return np.asarray(self.solver.now().slip)


def seconds(task: Callable[[], Any], times: int = 5) -> float:
    """Return the median processor time of a task (s)."""
    found = []
    for _ in range(times):
        begin = time.process_time()
        task()
        found.append(time.process_time() - begin)
    return statistics.median(found)


@cache
def truth(trips: int) -> Floats:
    return Ours(trips, FINE).slip()


def error(slip: Floats, trips: int) -> float:
    """Return the largest error of the slip at the end over the largest slip, against FINE steps in a round trip."""
    return float(np.abs(slip - truth(trips)).max() / truth(trips).max())


def at_equal_error() -> Iterator[tuple[str, ...]]:
    yield ("round trips", "method", "steps in R", "error", "processor time", "compiled sums alone")
    for trips in TRIPS:
        steps, found = next((n, run) for n in LADDER[1:] if error((run := Ours(trips, n)).slip(), trips) < TARGET)
        ours = seconds(found.again)
        yield (str(trips), "spectral (A)", str(steps), f"{error(found.slip(), trips):.1e}", f"{ours:.2f} s", "")
        for name, method, ladder, sums in (
            ("volume (B)", volume, LADDER, sums_of_volume),
            ("convolution", convolution, LADDER[2:], sums_of_convolution),
        ):
            for steps in ladder:
                begin = time.process_time()
                slip = method(case(), trips * ROUND, steps).slip[-1]
                spent, missed = time.process_time() - begin, error(slip, trips)
                if missed < TARGET:
                    break
            alone = trips * steps * statistics.mean(sums(steps, trips))
            yield ("", name, str(steps), f"{missed:.1e}", f"x {spent / ours:.0f}", f"x {alone / ours:.1f}")


def sums_of_volume(steps: int, trips: int) -> list[float]:
    """Return the time (s) that numba needs for one step of all lines of nodes."""
    now, before = np.random.default_rng(0).random((2, steps // 2 + 1, 2, NODES // 2 + 1))
    cosine = np.cos(np.linspace(0.0, 1.0, NODES // 2 + 1))
    lines_of_nodes(cosine, now, before)
    return [seconds(lambda: lines_of_nodes(cosine, now, before))]


def sums_of_convolution(steps: int, trips: int) -> list[float]:
    """Return the time (s) that numba needs for the two sums over the past, in the middle of each round trip."""
    count, found = trips * steps, []
    kernel, history = np.random.default_rng(0).random((count, NODES // 2 + 1)), np.zeros((count, 2, NODES // 2 + 1))
    result = np.zeros(history.shape[1:])
    convolved(kernel, history, 1, result)
    for trip in range(trips):
        n = trip * steps + steps // 2
        found.append(sum(seconds(lambda: convolved(kernel, history, past, result)) for past in (n, max(n - steps, 0))))  # noqa: B023
    return found


def step_by_step() -> Iterator[tuple[str, ...]]:
    steps, trips = 404, 10
    ours = Ours(trips, steps)
    ours.solver.trip = ours.solver.step = 0
    with our_settings():
        ours.solver._begin()
    found, sums = ours.finish(), sums_of_convolution(steps, trips)
    yield ("round trip", "a step", "its echo, once", "convolution: compiled sums of a step")
    for trip in (0, 1, 2, 4, 9):
        echo, rest = found[trip]
        yield (str(trip + 1), f"{1e6 * rest / (steps - 1):.0f} us", f"{1e3 * echo:.0f} ms", f"{1e6 * sums[trip]:.0f} us")


def memory() -> Iterator[tuple[str, ...]]:
    yield ("wavenumbers", "round trips", "exponentials", "waves of a round trip", "echoes to come", "convolution: history, kernels")
    for nodes in (256, 512, 1024):
        for trips in (1, 3, 10):
            slab = ss.PlanarSlab(ss.Problem(SLAB, LAW, initial_load=60e6), nodes=nodes, length=LENGTH)
            run = PlanarSolver(slab, trips * ROUND)
            parts = ((run.waves.memory, run.constants.half_space), run.waves[-2:], (run.echo, run.spectra))
            sizes = [sum(one.nbytes for one in jax.tree.leaves(part)) for part in parts]
            modes, steps = nodes // 2 + 1, run.steps * trips
            every = (*sizes, modes * steps * (2 * 16 + 2 * 8))
            yield (str(modes), str(trips), *(f"{size / 1e6:.1f} MB" for size in every))


def loops() -> Iterator[tuple[str, ...]]:
    yield ("exponentials of a step", "JAX", "numba", "C")
    for waves, poles in ((4096, 48), (65536, 28)):
        draw = np.random.default_rng(0)
        decay, gain = 0.7 * np.exp(1j * draw.random((2, waves, poles)))
        apart = [np.ascontiguousarray(np.stack([one.real, one.imag], axis=1)) for one in (decay, gain)]
        arrays = (*apart, np.zeros((waves, 2, 2, poles)), draw.random((waves, 2)), np.zeros((waves, 2)))
        plain = [f for f in (exponentials, exponentials_in_c()) if f is not None]
        for function in plain:
            function(*arrays)
        times = [seconds(lambda: function(*arrays), 25) for function in plain]  # noqa: B023
        ours = exponentials_in_jax(decay.T, gain.T, arrays[3].T)
        yield (f"{waves} x {poles}", f"{1e3 * ours:.2f} ms", *(f"x {one / ours:.2f}" for one in times))


def exponentials_in_jax(decay: Any, gain: Any, slip: Floats) -> float:
    """Return the time (s) of the solver's own update, of twenty in a loop."""
    with our_settings():
        decay, gain = jnp.asarray(decay[:, None]), jnp.asarray(gain[:, None])

        def twenty(memory: Any, inherited: Any) -> Any:
            def one(_: Any, now: Any) -> Any:
                return advanced(now[0], decay, gain, slip + 1e-3 * now[1])

            return jax.lax.fori_loop(0, 20, one, (memory, inherited))

        compiled = jax.jit(twenty, donate_argnums=0)
        now = compiled(jnp.zeros((decay.shape[0], *slip.shape), complex), jnp.zeros(slip.shape))
        found = []
        for _ in range(9):
            begin = time.process_time()
            now = jax.block_until_ready(compiled(*now))
            found.append((time.process_time() - begin) / 20)
        return statistics.median(found)


def whole_steps() -> Iterator[tuple[str, ...]]:
    """Yield whole steps of a contact, in the first round trip, with the solver, with JAX alone and with numba, which must agree."""
    yield ("nodes", "wavenumbers x poles", "steps in R", "a step", "steps per second", "JAX alone", "numba and scipy's FFT")
    law = ss.friction.LinearSlipWeakening(static=0.7, dynamic=0.5, distance=0.4)
    for nodes, width in ((256, 0), (1024, 0), (4096, 0), (64, 64), (128, 128), (256, 256)):
        plane: dict[str, Any] = {"width": 2e4, "width_nodes": width} if width else {}
        bump = {"initial.load": lambda *at: 60e6 + 11e6 * np.exp(-sum((x / 4e3) ** 2 for x in at))}
        slab = ss.PlanarSlab(ss.Problem(SLAB, law, initial_load=60e6), nodes=nodes, length=2e4, along=bump, **plane)
        run, jax_alone = PlanarSolver(slab, ROUND), in_jax_alone(slab)
        plain, each = NumbaSteps(run), min(50, run.steps // 8)
        times: list[list[float]] = [[], [], []]
        for _ in range(6):
            moments = [time.process_time()]
            for one in (run, jax_alone):
                one.advance(each)
                moments.append(time.process_time())
            for _ in range(each):
                plain.advance()
            moments.append(time.process_time())
            for found, spent in zip(times, np.diff(moments).tolist(), strict=True):
                found.append(spent / each)
        for one in (run, jax_alone):
            assert np.abs(one.now().slip.ravel() - plain.slip).max() < 1e-12 * plain.slip.max()
        ours, alone, numba = (statistics.median(found[1:]) for found in times)
        waves = f"{plain.waves} x {plain.memory.shape[-1]}"
        name = f"{nodes} x {width}" if width else str(nodes)
        others = (f"x {one / ours:.2f}" for one in (alone, numba))
        yield (name, waves, str(run.steps), f"{1e3 * ours:.3f} ms", f"{1 / ours:.0f}", *others)


def in_jax_alone(slab: ss.PlanarSlab) -> PlanarSolver:
    """Return a solver whose half-space is advanced step by step in JAX, as on a graphics card."""
    functions_of.cache_clear()
    with patch("stickslip.extensions.planar.half_space.target", return_value=""):
        run = PlanarSolver(slab, ROUND)
        run.advance(1)
    functions_of.cache_clear()
    run.trip = run.step = 0
    with our_settings():
        run._begin()
    return run


def main() -> None:
    for title, rows in (
        (f"To an error of {TARGET:g} of the slip, {NODES} nodes", at_equal_error()),
        ("Step by step", step_by_step()),
        ("Memory", memory()),
        ("The exponentials alone", loops()),
        ("Whole steps", whole_steps()),
    ):
        sys.stdout.write(f"\n{title}\n\n")
        for i, row in enumerate(rows):
            lines = [row, ("---",) * len(row)] if i == 0 else [row]
            for line in lines:
                sys.stdout.write("| " + " | ".join(line) + " |\n")


if __name__ == "__main__":
    main()
