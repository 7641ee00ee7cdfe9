"""
Friction from stick-slip
========================

A block on a spring sticks and slips. Its force falls by twice the difference of static and dynamic friction, because the block has
a mass, in half a period of its oscillation. A record of the spring's force therefore tells both frictions, stiffness and mass.

You learn to fit slip events one by one, each from its own rest.
"""

import numpy as np

import stickslip as ss

truth = ss.Problem(
    ss.SpringBlock(mass="2 kg", stiffness="4 kN/mm", normal_force="1 kN"),
    ss.friction.Coulomb(static=0.65, dynamic=0.5),
    pull_rate="1 mm/s",
    initial_load="300 N",
)
run = ss.simulate(truth, "0.3 s")
time = np.arange(0.0, 0.3, 1e-4)
force = run.load(time) + np.random.default_rng(0).standard_normal(len(time))
record = {"time (s)": time, "shear force (N)": force, "load point (mm)": 1.0 * time}

# %%
# The search begins with other numbers. The load cell is behind the spring, and each event begins with the force that was measured
# at its rest.

guess = ss.Problem(
    ss.SpringBlock(mass="1.5 kg", stiffness="5 kN/mm", normal_force="1 kN"),
    ss.friction.Coulomb(static=0.7, dynamic=0.4),
    pull_rate="1 mm/s",
    initial_load="300 N",
)
found = ss.studies.infer(guess, record, ["static", "dynamic", "stiffness", "mass"], sensor="spring", parts="rests", starts=1)
print(found)

figure = found.plot()
