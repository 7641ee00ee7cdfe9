"""Bodies of layers against a program of its own: every wave in every cell, at many phases (`layer_chains`)."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.core.problem.bodies.layer_chains import PHASES, Chain, march

WITH_DRAG = 18
"""From this seed on, layers have drag."""


def cut_with_drag(chains: list[Chain], body: Any, fields: dict[str, Any]) -> float:
    """Cut chains into halves of cells with a drag in the middle of each cell, and return the time (s) of a half."""
    for chain, prefix, stack in zip(chains, ("", "other_"), body.stacks, strict=False):
        speed, density, lasting = fields[f"{prefix}wave_speed"], fields[f"{prefix}density"], 2.0 * stack.time
        counts = np.rint(fields[f"{prefix}thickness"] / (speed * lasting)).astype(int)
        np.testing.assert_allclose(counts * lasting * speed, fields[f"{prefix}thickness"], rtol=1e-9)
        halves = np.repeat(density * speed, 2 * counts)
        lost = np.repeat(fields[f"{prefix}drag"] * speed * lasting, 2 * counts)
        lost[1::2] = 0.0
        chain.impedances, chain.drags = halves, lost[:-1]
    return float(body.stacks[0].time)


def drawn(seed: int) -> tuple[Any, list[Chain], float, ss.Problem]:
    """Return a body of layers, the same as chains of fine cells with their time (s), and a problem, all drawn at random."""
    draw = np.random.default_rng(seed)
    kind, drags = ("one", "apart", "joined")[seed % 3], seed >= WITH_DRAG
    time, normal, pull = 0.01, 1e7, float(draw.uniform(0.05, 0.5))
    fields: dict[str, Any] = {"drag_step": float(draw.uniform(0.1, 0.4))} if drags else {}
    chains = []
    for prefix in ("",) if kind == "one" else ("", "other_"):
        count = int(draw.integers(1, 4))
        cells = draw.integers(1, 6, count)
        density, speed = draw.uniform(1500.0, 3500.0, count), draw.uniform(500.0, 4000.0, count)
        rigid = draw.random() < 0.5
        zs = density * speed
        driver = math.inf if rigid else float(zs[-1] * draw.uniform(0.0, 3.0))
        fields |= {f"{prefix}density": density, f"{prefix}wave_speed": speed, f"{prefix}thickness": cells * time * speed}
        fields[f"{prefix}driver_impedance"] = driver
        if drags:
            fields[f"{prefix}drag"] = draw.uniform(0.0, 1.0, count) * density / (time * sum(cells))
        chains.append(Chain(np.repeat(zs, cells), driver, pull, 1.0))
    body = (
        ss.LayeredSlab(**fields, normal_stress=normal) if kind == "one" else ss.TwoSlabs(**fields, normal_stress=normal, sides=kind)
    )
    if drags:
        time = cut_with_drag(chains, body, fields)
    if kind == "apart":
        chains[1].rate = 0.0
    static, dynamic = float(draw.uniform(0.5, 0.8)), float(draw.uniform(0.2, 0.45))
    critical = body.impedance / (normal * (static - dynamic))
    law = (
        ss.friction.Coulomb(static, dynamic)
        if seed % 2
        else ss.friction.HyperbolicRate(static, dynamic, critical * float(draw.choice([0.4, 2.5])))
    )
    return body, chains, time, ss.Problem(body, law, pull_rate=pull, initial_excess=float(-draw.uniform(0.0, 1e4)))


@pytest.mark.sampled(every=33)
@pytest.mark.parametrize("seed", range(30))
def test_layers_drawn_at_random_move_as_their_waves_do(seed: int) -> None:
    body, chains, time, problem = drawn(seed)
    stiffness = [1.0 / (time * np.sum(1.0 / chain.impedances)) for chain in chains]
    joined = seed % 3 == 2
    pull = problem.pull_rate
    if len(chains) == 1:
        rates = [(0.0, pull)]
    elif joined:
        rates = [(0.0, pull), (0.0, pull)]
        for chain, one in zip(chains, stiffness, strict=True):
            chain.share = one / sum(stiffness)
    else:
        slow = pull * stiffness[0] / sum(stiffness)  # the contact, at rest, moves between the drivers
        rates = [(slow, pull), (-slow, 0.0)]
    steps = round(4.0 / time)
    known = march(chains, joined, problem.friction, problem.normal, time, steps, {"rates": rates, "stress": problem.load})
    run = ss.simulate(problem, steps * time, max_pieces=100_000)
    times = (np.arange(steps)[:, None] + (np.arange(PHASES) + 0.5) / PHASES) * time
    reached = times <= run.duration  # one of them slips ever more often, as a uniform slab of this kind does
    times, known = times[reached], known[reached]
    rate = run.slip_rate(times)
    assert run.duration > 0.5 * steps * time
    assert np.abs(known).max() > 1e-3
    # An onset or an arrest between two phases may be late by one of them; a repelling orbit may take the two apart in the end.
    off = np.abs(rate - known) > 1e-9 * np.abs(known).max() + 1e-7 * np.abs(known)
    assert off.mean() < 0.002, (type(body).__name__, off.mean(), times[off][:5])


def slip_on_grid(
    chains: list[Chain], joined: bool, law: Any, normal: float, step: float, steps: int, start: dict[str, Any]
) -> float:
    """Return the slip (m) after a number of steps under a law of slip: a volume method at CFL 1, by the trapezoidal rule."""
    for chain, (contact, end) in zip(chains, start["rates"], strict=True):
        chain.begin(np.zeros(1), step, contact, end, start["stress"])
    firsts = [chain.impedances[0] for chain in chains]
    impedance = sum(firsts) if joined else 1.0 / sum(1.0 / z for z in firsts)
    slip = rate = 0.0
    for _ in range(steps):
        arriving = [float(chain.cross()[0]) for chain in chains]
        load = sum((1.0 if joined else impedance / z) * one for z, one in zip(firsts, arriving, strict=True))
        before, moved = rate, slip + step * rate
        last = math.inf
        while abs(moved - last) > 1e-15 * abs(moved):  # a contraction: S mu' step / Z is small
            rate = (load - normal * float(law.coefficient(moved, 0.0))) / impedance
            last, moved = moved, slip + 0.5 * step * (before + rate)
        slip = moved
        for chain, one in zip(chains, arriving, strict=True):
            chain.away[0] = 2.0 * chain.impedances[0] * rate - one if joined else one - 2.0 * (load - impedance * rate)
    return slip


SIDES: dict[str, dict[str, Any]] = {"one": {}, "apart": {"sides": "apart"}, "joined": {"sides": "joined"}}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", SIDES)
def test_a_volume_method_at_cfl_1_converges_to_the_run(kind: str) -> None:
    time, normal = 0.01, 1e7
    law = ss.friction.ExponentialSlipWeakening(0.7, 0.4, 0.005 if kind == "joined" else 0.05)
    first, other = ((2200.0, 2700.0), (1500.0, 3000.0), (2, 3)), ((2500.0,), (2000.0,), (3,))
    stacks = (first,) if kind == "one" else (first, other)
    lists = [(np.array(counts) * time * np.array(c), rho, c) for rho, c, counts in stacks]
    flat = [one for lists_of_side in lists for one in lists_of_side]
    body = (ss.LayeredSlab if kind == "one" else ss.TwoSlabs)(*flat, normal, **SIDES[kind])
    problem = ss.Problem(body, law, pull_rate=0.0, initial_excess=1e5)
    steps = 9  # crossings of a cell: echoes have come back from each layer, and slip has not stopped
    run = ss.simulate(problem, steps * time)
    assert run.slip_rate(steps * time) > 0.0
    errors = []
    for finer in (8, 16, 32):
        zs = [np.repeat(np.array(rho) * np.array(c), finer * np.array(counts)) for rho, c, counts in stacks]
        stiffness = [1.0 / np.sum(1.0 / one) for one in zs]
        chains = [
            Chain(one, math.inf, 0.0, of / sum(stiffness) if kind == "joined" else 1.0)
            for one, of in zip(zs, stiffness, strict=True)
        ]
        start = {"rates": [(0.0, 0.0)] * len(chains), "stress": problem.load}
        found = slip_on_grid(chains, kind == "joined", law, normal, time / finer, steps * finer, start)
        errors.append(abs(found - float(run.slip(steps * time))))
    # where a front arrives at the end of a step the rule is of first order, elsewhere of second
    assert errors[-1] < 4e-3 * float(run.slip(steps * time))
    assert all(1.8 < coarse / fine < 4.2 for coarse, fine in pairwise(errors)), errors
