"""A chain beside the slab: blocks coupled in a row, with friction under the first of them alone, become the paper's elastic slab.

A slab of n layers, each a mass rho h/n on springs G n/h, is a chain whose first block has the friction of the contact, and whose
last hangs on the driver. Its dispersion, omega = (2 c n/h) sin(k h/(2 n)), is that of the slab to order 1/n^2 in the wavenumber.
The first block stands for the half layer beside the contact only, so that its mass is rho h/(2 n): one with the mass of the others
carries as much again, which is the slab with a `contact_mass` of rho h/(2 n), and is 1/n away.

A step of slip rate, as friction that falls at once makes it, becomes an Airy front: u_t + c u_x + (c dx^2/24) u_xxx = 0 spreads it
over (c t dx^2/8)^(1/3) after a time t, with an overshoot of 27 % that no number of blocks takes away.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.compiled.advance import begin
from stickslip.extensions.chains.compiled.memory import KeptRows
from stickslip.extensions.chains.run import ChainRun
from stickslip.extensions.chains.solver import ChainSolver, solve_chain
from stickslip.extensions.chains.state import ChainState
from stickslip.foundation.arguments import check_whole, for_users, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import number
from stickslip.problem import Problem, block_for
from stickslip.problem.bodies import ElasticSlab
from stickslip.problem.scenarios import read_source
from stickslip.run import Study, TextProgress, telling, uninterrupted
from stickslip.run.simulate import simulate

if TYPE_CHECKING:
    from stickslip.problem.scenarios import Scenario
    from stickslip.solution import Solution

HALF, WHOLE = "half", "whole"
"""The first block has half of the mass of the others, or the same."""
TIMES_COMPARED = 2_001
"""Slip is compared at so many even times."""
MOST_ROUND_TRIPS = 1_000
"""Compare for at most so many round trips: the blocks without friction never rest, and no time is passed over."""
MOST_BLOCKS = 4_096
FEWEST_BLOCKS = 4
TENTHS = (0.1, 0.9)
"""A front is as wide as the time that its slip rate takes between these shares of the jump."""
AIRY_WIDTH, AIRY_PEAK = 2.167643, 1.274352
"""The distance between the first tenth and the first nine tenths of the integral of Airy's function from infinity, and its peak."""
AROUND_FRONT = 6.0
"""Look for a front so many of its lengths before and after that of the slab."""


@dataclass(frozen=True, eq=False, repr=False)
class ChainBesideSlab(Study):
    """The result of `chain_beside_slab`: chains of more and more blocks beside the slab that they become.

    The `table` has one row for each number of blocks and mass of the first block. Columns: blocks; first_block, "half" or "whole";
    difference (m), the largest between the slips of first block and contact; order, how fast it falls with the number of blocks
    against the row before of this kind; difference_with_mass and order_with_mass, the same beside the slab with a contact mass of
    half a block, for whole first blocks; front and airy_front (s), for how long the slip rate of the middle rises from a tenth to
    nine tenths of the slab's first jump, measured and by Airy's function; peak, the largest slip rate there as a share of the jump
    (NaN where the slab has no shock).
    """

    problem: Problem
    duration: float
    slab: Solution
    runs: dict[tuple[int, str], ChainRun]
    table: pd.DataFrame

    def slip(self, blocks: int, first_block: str, times: Floats) -> Floats:
        """Return the slip (m) of the first block of a chain at times (s)."""
        return slip_of(self.runs[blocks, first_block], self.problem, times)

    def last_order(self, first_block: str, column: str = "order") -> float:
        """Return the order between the two largest numbers of blocks."""
        return float(self.table[self.table.first_block == first_block][column].iloc[-1])

    @property
    def texts(self) -> tuple[str, ...]:
        """How the chains approach the slab, with half a mass at the contact, with equal masses, and beside the slab with a mass."""
        most = int(self.table.blocks.max())
        last = self.table[self.table.blocks == most].set_index("first_block")

        def said(first: str, column: str, order: str) -> str:
            return f"{number(last[column][first], 3)} m, falling as 1/n to the power {self.last_order(first, order):.2f}"

        return (
            f"slip of {most} blocks against the slab's, half a mass at the contact: {said(HALF, 'difference', 'order')}",
            f"equal masses: {said(WHOLE, 'difference', 'order')}",
            f"equal masses, and a slab with half a block on its contact: {said(WHOLE, 'difference_with_mass', 'order_with_mass')}",
        )

    @property
    def front_text(self) -> str:
        """How wide a front is in place of the slab's first shock; "" if it has none."""
        last = self.table.iloc[-1]
        if math.isnan(last.front):
            return ""
        return (
            f"in place of the shock the rate in the middle of {int(last.blocks)} blocks rises in {number(last.front, 3)} s "
            f"(Airy's front: {number(last.airy_front, 3)} s) and overshoots to {last.peak:.3f} of the jump"
        )

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.chains.figures.beside_slab import draw_beside_slab

        return draw_beside_slab

    def _sentences(self) -> tuple[str, ...]:
        return *self.texts, self.front_text


@for_users
def chain_beside_slab(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None = None,
    blocks: Sequence[int] = (16, 32, 64, 128),
    *,
    progress: TextProgress | bool | None = None,
) -> ChainBesideSlab:
    """Compare an elastic slab with chains of blocks that have friction under the first block only.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        A problem of an `ElasticSlab` under a rigid driver, its scenario, the name of a bundled scenario, or a scenario file.
    duration : float or str, optional
        How long to compare (s, or a text with a unit); by default as long as the scenario says. At most 1000 round trips.
    blocks : sequence of int
        Numbers of blocks, ascending.
    progress : bool or callable, optional
        True shows the progress in one line; a function is called with a line of text before each run.

    Raises
    ------
    InputError
        If the body is no slab under a rigid driver, if its contact has a mass, if pull or normal stress vary, if the contact slides
        at the start or does not slip at all, if the law is one that chains do not follow, or if a number is out of range.

    Examples
    --------
    >>> import stickslip as ss
    >>> slab = ss.ElasticSlab(density=1.0, wave_speed=1.0, thickness=1.0, normal_stress=1.0)
    >>> law = ss.friction.LinearSlipWeakening(static=0.8, dynamic=0.3, distance=0.2)
    >>> problem = ss.Problem(slab, law, pull_rate=0.01, initial_excess=0.0)
    >>> found = ss.studies.chain_beside_slab(problem, 2.0, blocks=(8, 16, 32))
    >>> print(f"{found.last_order('half'):.1f} {found.last_order('whole'):.1f}")
    2.0 0.8
    """
    scenario = read_source("chain_beside_slab", problem, duration)
    given, lasts = scenario.problem, float(scenario.duration)
    body = checked_slab(given)
    if lasts > MOST_ROUND_TRIPS * body.two_way_time:
        limit = MOST_ROUND_TRIPS * body.two_way_time
        raise InputError(
            f"chain_beside_slab: duration must be at most {MOST_ROUND_TRIPS} round trips, {limit:.6g} s, got {lasts:.6g} s: blocks "
            "without friction never rest, so that no time is passed over"
        )
    counts = checked_counts(blocks)
    times = np.linspace(0.0, lasts, TIMES_COMPARED)
    runs: dict[tuple[int, str], ChainRun] = {}
    rows: list[dict[str, Any]] = []
    with telling(progress, "chain_beside_slab") as tell:
        tell("the slab")
        slab = uninterrupted(simulate(given, lasts))
        exact = slab.slip(times) - given.initial_slip
        check_slips(exact, lasts)
        for count in counts:
            tell(f"{count} blocks")
            half_mass = 0.5 * body.density * body.thickness / count
            heavy = uninterrupted(simulate(replace(given, body=replace(body, contact_mass=half_mass)), lasts))
            for first in (HALF, WHOLE):
                run = runs[count, first] = run_beside(given, count, first, lasts)
                slip = slip_of(run, given, times)
                row = {"blocks": count, "first_block": first, "difference": float(np.abs(slip - exact).max())}
                with_mass = float(np.abs(slip - heavy.slip(times) + given.initial_slip).max()) if first == WHOLE else math.nan
                rows.append(row | {"difference_with_mass": with_mass} | front_of(run, slab, given))
    return ChainBesideSlab(given, lasts, slab, runs, with_orders(pd.DataFrame(rows)))


def checked_slab(problem: Problem) -> ElasticSlab:
    """Return the slab of a problem that a chain can stand for. Raises InputError."""
    body = problem.body
    why = ""
    if not isinstance(body, ElasticSlab) or body.contact_mass or not _has_block(problem):
        why = "needs an ElasticSlab under a rigid driver, whose contact has no mass"
    elif problem.varies or problem.ground is not None:
        why = "needs a constant pull rate and normal stress, and ground that does not move"
    elif problem.rate != 0.0:
        why = "needs a contact that rests at the start"
    if why:
        raise InputError(f"chain_beside_slab: {why}")
    assert isinstance(body, ElasticSlab)
    return body


def _has_block(problem: Problem) -> bool:
    """Return True if a block can stand for the body, which needs a rigid driver."""
    try:
        block_for(problem)
    except InputError:
        return False
    return True


def check_slips(slip: Floats, duration: float) -> None:
    """Refuse a slab that stays at rest: chains would be 0 m away from it, and at no order. Raises InputError."""
    if not slip.any():
        raise InputError(
            f"chain_beside_slab: the contact of the slab does not slip within {duration:.6g} s: take a longer duration, or "
            "begin at the strength with initial_excess=0"
        )


def checked_counts(blocks: Any) -> list[int]:
    """Return ascending numbers of blocks. Raises InputError."""
    if not isinstance(blocks, list | tuple | range | np.ndarray) or len(blocks) < 2:
        raise InputError(f"chain_beside_slab: blocks must be two or more numbers, such as (16, 32, 64), got {shown(blocks)}")
    counts = [check_whole("chain_beside_slab: blocks", one, FEWEST_BLOCKS, MOST_BLOCKS) for one in blocks]
    if any(later <= earlier for earlier, later in pairwise(counts)):
        raise InputError(f"chain_beside_slab: blocks must ascend, got {', '.join(map(str, counts))}")
    return counts


def run_beside(problem: Problem, count: int, first: str, duration: float) -> ChainRun:
    """Run the chain of so many blocks that stands for 1 m^2 of a slab."""
    body = checked_slab(problem)
    place = np.arange(count) / count
    mass = np.full(count, body.density * body.thickness / count)
    mass[0] *= 0.5 if first == HALF else 1.0
    spring = body.shear_modulus * count / body.thickness
    stiffness, normal = np.zeros(count), np.zeros(count)
    stiffness[-1], normal[0] = spring, body.normal_stress
    bent = problem.load * body.thickness / body.shear_modulus * (place - 1.0)
    pull = float(problem.pull_rate_at(0.0))
    chain = Chain(problem.friction, count, mass, spring, stiffness, normal, pull, initial_slip=bent)
    return solve_chain(chain, duration, start_beside(chain, bent, pull * place, problem.law_slip))


def start_beside(chain: Chain, slip: Floats, rate: Floats, counted: float) -> ChainState:
    """Return the state of a chain whose free blocks move at the start, and whose law has counted a slip (m)."""
    solver, state = ChainSolver(chain), ChainState.empty(chain.count)
    state.blocks[at.SLIP], state.blocks[at.RATE_NOW], state.blocks[at.COUNTED] = slip, rate, counted
    nothing = KeptRows(
        np.empty((0, at.CHANGE_COLUMNS)), np.empty((1, at.EVENT_COLUMNS)), np.empty(0), np.empty((0, 0)), np.empty((0, 0))
    )
    begin(solver.numbers, state.memory, solver.room, nothing)
    return state


def slip_of(run: ChainRun, problem: Problem, times: Floats) -> Floats:
    """Return the slip (m) of the first block at times (s) since the start."""
    body = checked_slab(problem)
    return run.at(times).slip[:, 0] + problem.load * body.thickness / body.shear_modulus


def front_of(run: ChainRun, slab: Solution, problem: Problem) -> dict[str, float]:
    """Return the width (s) of the front in the middle of a chain, that of Airy's front, and the peak as a share of the jump."""
    body, nothing = checked_slab(problem), dict.fromkeys(("front", "airy_front", "peak"), math.nan)
    shocks = slab.shocks
    if not len(shocks):
        return nothing
    time, jump = float(shocks.time.iloc[0]), float(shocks.rate_after.iloc[0] - shocks.rate_before.iloc[0])
    middle = run.chain.count // 2
    way = body.thickness * middle / run.chain.count
    spacing = body.thickness / run.chain.count
    length = (way * spacing**2 / 8.0) ** (1.0 / 3.0)
    arrives = time + way / body.wave_speed
    end = arrives + AROUND_FRONT * length / body.wave_speed
    if end > min(run.duration, time + 2.0 * body.thickness / body.wave_speed - way / body.wave_speed):
        return nothing
    times = np.linspace(arrives - AROUND_FRONT * length / body.wave_speed, end, 4001)
    times = times[times >= 0.0]
    rate = run.at(times).slip_rate[:, middle]
    share = (rate - rate[0]) / jump
    reached = [float(times[np.argmax(share >= level)]) if share.max() >= level else math.nan for level in TENTHS]
    return {"front": reached[1] - reached[0], "airy_front": AIRY_WIDTH * length / body.wave_speed, "peak": float(share.max())}


def with_orders(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table with how fast differences fall with the number of blocks."""
    grouped = table.groupby("first_block")
    ratio = np.log(table.blocks / grouped.blocks.shift())
    found = {
        order: np.log(grouped[column].shift() / table[column]) / ratio
        for order, column in (("order", "difference"), ("order_with_mass", "difference_with_mass"))
    }
    given = ("blocks", "first_block", "difference", "order", "difference_with_mass", "order_with_mass")
    return table.assign(**found)[[*given, "front", "airy_front", "peak"]]
