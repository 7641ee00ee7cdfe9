"""
An axis that reverses
=====================

A machine slide is driven to and fro. Within the first micrometres its contact gives way like a spring, and after each reversal
friction turns round with a delay: friction against displacement is a loop.

You learn to run a law with a state that remembers the direction, and to draw its hysteresis.
"""

import matplotlib.pyplot as plt
import numpy as np

import stickslip as ss

run = ss.simulate("reversing-axis")

# %%
# One cycle of the drive lasts 0.2 s. The area of the loop is the work of friction.

cycle = np.linspace(0.2, 0.4, 20001)
work = np.trapezoid(run.traction(cycle) * run.slip_rate(cycle), cycle)
print(f"{work * 1e3:.2f} mJ a cycle, {np.ptp(run.slip(cycle)) * 1e6:.1f} um to and fro")

figure, (loop, rates) = plt.subplots(1, 2, figsize=(9.0, 3.2), layout="constrained")
run.plot.friction(0.2, 0.4, ax=loop)
run.plot.friction(0.2, 0.4, against="slip_rate", ax=rates)
