"""
Stick-slip of a drill string
============================

The bit of a drill string stops and spins while the drive turns steadily. Here the speed of the drive and the weight on the bit are
varied, as a driller can, and each run tells how severe its stick-slip is.

You learn to turn a string in torsion, to draw a map of two numbers, and to find the edge where stick-slip ends.
"""

from dataclasses import replace
from math import pi

import numpy as np
from matplotlib import pyplot

import stickslip as ss

RPM = pi / 30  # rad/s
problem = ss.load_scenario("drill-string").problem

# %%
# The bit is followed for 150 s from rest. Drillers call half the range of its speed over its mean the severity: 0 in steady
# turning, and about 1 or more in full stick-slip, where the bit stops again and again. A sweep takes it from the last third of a
# run. Its own figure, `ss.figures.plot_sweep(map, "severity")`, has a line at 1, too.


weights = np.linspace(40e3, 110e3, 8)
speeds = np.linspace(40.0, 160.0, 13) * RPM
varied = {"weight_on_bit": weights, "pull_rate": speeds}
severities = ss.sweep(problem, varied, duration="150 s", quantities=["severity"]).severity.values

# %%
# The edge is found by bisection on exact runs: up to this speed a bit that starts from rest goes on sticking. Above the other line,
# a bit that turns already goes on turning. Between the two, what the bit did before decides.

edges, turning = [], []
for weight in weights:
    found = ss.studies.steady(replace(problem, body=replace(problem.body, weight_on_bit=weight), pull_rate="100 rpm"))
    edges.append(found.from_rest.sticks_at)
    turning.append(found.changes[0].rate)
    print(f"{weight / 1e3:.0f} kN: sticks up to {edges[-1] / RPM:.0f} rpm, turning goes on above {turning[-1] / RPM:.0f} rpm")

figure, axes = pyplot.subplots(figsize=(6.4, 4.0), layout="constrained")
shades = axes.pcolormesh(speeds / RPM, weights / 1e3, severities, cmap="viridis", vmin=0.0)
axes.contour(speeds / RPM, weights / 1e3, severities, levels=[1.0], colors="tab:orange")
axes.plot([], [], color="tab:orange", label="severity 1")
axes.plot(np.array(edges) / RPM, weights / 1e3, color="w", label="from rest it sticks up to here")
axes.plot(np.array(turning) / RPM, weights / 1e3, color="w", ls="--", label="turning goes on from here")
figure.colorbar(shades, label="severity of stick-slip (1)")
axes.set(xlabel="speed of the drive (rpm)", ylabel="weight on the bit (kN)", title="Where a drill string sticks", xlim=(35, 165))
axes.legend(facecolor="0.4", labelcolor="w", fontsize="small", loc="center left", bbox_to_anchor=(0.12, 0.5))
