"""
Friction parameters from velocity steps
=======================================

A laboratory record of velocity steps shows the friction law and the machine at once: the spring gives while friction jumps. Runs
of the whole machine are fitted to it, so that a, b, the distance and the stiffness come out together, each with its interval.

You learn to fit a record, to read what it determines, and to look at the fit.
"""

from dataclasses import replace

import numpy as np

import stickslip as ss

problem = ss.load_scenario("velocity-steps-block").problem
law = replace(problem.friction, reference=0.62, a=0.008, b=0.0125, distance="15 um")
truth = replace(problem, friction=law, body=replace(problem.body, stiffness="60 kN/mm"))
run = ss.simulate(truth, "700 s")

# The record: the displacement of the load point, and friction with noise that remembers itself for 2 s.

time = np.arange(0.0, 700.0, 0.25)
changes = {0.0: 1e-6, 200.0: 9e-6, 250.0: -9e-6, 500.0: 99e-6, 510.0: -99e-6}
moved = sum(change * np.maximum(time - at, 0.0) for at, change in changes.items())
white = np.random.default_rng(2).standard_normal(len(time))
noise = np.zeros(len(time))
for i in range(1, len(time)):
    noise[i] = 0.88 * noise[i - 1] + 0.47 * white[i]
record = {"time (s)": time, "load point (m)": moved, "friction": run.traction(time) / 50e3 + 3e-4 * noise}

found = ss.studies.infer(problem, record, ["a", "b", "distance", "stiffness", "reference"], starts=2)
print(found)

# %%
# The true numbers are a = 0.008, b = 0.0125, 15 um and 60 MN/m. Residuals that remember themselves tell less than independent
# ones: the intervals allow for it.

figure = found.plot()
