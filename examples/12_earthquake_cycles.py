"""
Earthquake cycles of a block
============================

Friction that weakens with slip and heals at every arrest makes a block slip again and again. A thousand years take a fraction
of a second, because rest is passed over.

You learn to make a catalogue of events, and to look at one cycle on all its time scales.
"""

import stickslip as ss

cycles = ss.scenarios["cycles-block"]
table = ss.catalogue(cycles.problem, "1000 years")
gaps = table.start.diff().dropna() / ss.YEAR
print(f"{len(table)} events, one every {gaps.mean():.5f} years")

# %%
# The spring must be pulled back by what it lost: the recurrence time is the slip of an event divided by the pull rate.

wait = table.slip.iloc[0] / cycles.problem.pull_rate / ss.YEAR
print(f"slip / pull rate = {wait:.5f} years")

# %%
# The figure shows a shorter run with its whole history: all events, and one of them from years down to milliseconds.

figure = ss.simulate(cycles.problem, "30 years").plot.catalogue()
