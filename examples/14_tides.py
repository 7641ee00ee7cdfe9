"""
Do tides trigger earthquakes?
=============================

The block of the cycles, pulled by plate motion with a tide of 5 kPa on it. The spring loads by less from one high tide to the
next than the tide itself, so the strength is first reached shortly before a high tide.

You learn to let the pull rate vary in time, and to ask a catalogue a question.
"""

import numpy as np
from matplotlib import pyplot

import stickslip as ss

scenario = ss.scenarios["tides-block"]
period = 12.42 * 3600
table = ss.catalogue(scenario.problem, scenario.duration)

# %%
# The tidal load is lowest at the start, so high tides come half a period later, and every 12.42 hours.

hours = (0.5 * period - table.start % period) / 3600
print(f"{len(table)} events; hours before high tide: {hours.round(2).tolist()}")

figure, axes = pyplot.subplots(figsize=(6.4, 3.4), layout="constrained")
around = np.linspace(-6.21, 6.21, 300)
axes.plot(around, 5 * np.cos(2 * np.pi * around * 3600 / period), label="tide (kPa)")
axes.plot(-hours, 5 * np.cos(2 * np.pi * hours * 3600 / period), "o", label="starts of events in 30 years")
axes.set(xlabel="hours after high tide", ylabel="tidal stress (kPa)", title="Events begin shortly before high tide")
axes.legend()
