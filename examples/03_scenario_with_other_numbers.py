"""
A scenario with other numbers
=============================

Scenarios are text files with a body, a law, a load and a duration. Twenty-eight are bundled with the package. This example
takes the one of Figure 6 and lets the slab be pulled through drivers of different impedance: a rigid one sends the whole wave
back, one of the slab's own impedance none of it.

You learn to start from a bundled scenario, to change one number, and to draw several runs in one figure.
"""

from dataclasses import replace

from matplotlib import pyplot

import stickslip as ss

scenario = ss.scenarios["fig6-slab"]
figure, axes = pyplot.subplots(figsize=(6.4, 4.0), layout="constrained")
for ratio in (float("inf"), 4.0, 1.0, 0.25):
    slab = replace(scenario.problem.body, driver_impedance=ratio * scenario.problem.body.impedance)
    problem = replace(scenario.problem, body=slab, pull_rate=0.0, initial_excess=1e3)
    run = ss.simulate(problem, "25 s")
    time, rate = run.curve("slip_rate")
    axes.plot(time, rate, "--" if ratio > 4.0 else "-", label=f"{ratio:g} times the slab's impedance")
    reflection = 2 / (1 + ratio) - 1
    print(f"reflection {reflection:+.2f}: {len(run.shocks)} jumps of the slip rate, {run.slip(25.0):7.2f} m of slip in 25 s")

axes.set(xlabel="time (s)", ylabel="slip rate (m/s)", title="Fig. 6 of the paper behind four drivers")
axes.legend(title="driver", loc="upper left")

# %%
# With reflection 0 nothing returns, and the slab slips on at the rate of the start. A driver that is softer than the slab
# returns the wave with its sign unchanged: the slab accelerates with every round trip.
