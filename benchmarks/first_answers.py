"""Small programs of five peers that print their first answer to a question of the kind that they are for.

scipy and heyoka get the same question, a block under a law of slip that comes to rest, and the others one of their own: a delay
equation, a diagram of blocks, and a rigid block on ground that shakes. Where a peer can answer in two ways, the quicker is taken:
JiTCDDE without its C compiler, and heyoka without sympy. It imports sympy where that is installed, for half a second, and JiTCDDE,
which stands beside it here, needs it.
"""

from __future__ import annotations

from typing import NamedTuple


class Peer(NamedTuple):
    """A peer, the module by which it is imported, what it is asked, the program that asks, and a number of its answer."""

    name: str
    module: str
    question: str
    program: str
    answer: float


PEERS = (
    Peer(
        "scipy",
        "scipy",
        "block, slip law, arrest located",
        """
from math import sin
from scipy.integrate import solve_ivp

def motion(t, state):
    slip, rate = state
    return [rate, 1.0 - slip - 0.9 * sin(5.0 * slip)]

def arrest(t, state):
    return state[1]

arrest.terminal, arrest.direction = True, -1.0
run = solve_ivp(motion, (0.0, 10.0), [0.0, 0.0], "DOP853", events=arrest, rtol=1e-10, atol=1e-12)
print(run.t[-1])
""",
        3.55550082865,
    ),
    Peer(
        "heyoka",
        "heyoka",
        "block, slip law, arrest located",
        """
import sys

sys.modules["sympy"] = None  # as if it were not installed

import heyoka

slip, rate = heyoka.make_vars("slip", "rate")
motion = [(slip, rate), (rate, 1.0 - slip - 0.9 * heyoka.sin(5.0 * slip))]
arrest = heyoka.t_event(rate, direction=heyoka.event_direction.negative)
block = heyoka.taylor_adaptive(motion, [0.0, 0.0], t_events=[arrest])
block.propagate_until(10.0)
print(block.time)
""",
        3.55550082865,
    ),
    Peer(
        "pySLAMMER",
        "pyslammer",
        "rigid block, one bundled record",
        """
import pyslammer

motion = pyslammer.sample_ground_motions()["Northridge_1994_PAC-175"]
print(pyslammer.RigidAnalysis(0.1, motion).max_sliding_disp)
""",
        0.0746,
    ),
    Peer(
        "JiTCDDE",
        "jitcdde",
        "Mackey and Glass's delay equation",
        """
from jitcdde import jitcdde, t, y

past = y(0, t - 15.0)
run = jitcdde([0.25 * past / (1.0 + past**10) - 0.1 * y(0)], verbose=False)
run.constant_past([1.0])
run.generate_lambdas()
run.step_on_discontinuities()
print(run.integrate(100.0)[0])
""",
        1.264,
    ),
    Peer(
        "PathSim",
        "pathsim",
        "oscillator of three blocks",
        """
from pathsim import Connection, Simulation
from pathsim.blocks import Amplifier, Integrator
from pathsim.solvers import RKBS32

slip, rate, spring = Integrator(0.0), Integrator(1.0), Amplifier(-1.0)
wires = [Connection(rate, slip), Connection(slip, spring), Connection(spring, rate)]
Simulation([slip, rate, spring], wires, dt=0.01, Solver=RKBS32, log=False).run(10.0)
print(slip.outputs[0])
""",
        -0.544,
    ),
)
