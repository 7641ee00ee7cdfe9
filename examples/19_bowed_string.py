"""
A bowed string
==============

The equations of a bowed string are those of the slab: a wave impedance, a delay, and friction that falls with slip rate. This
is a cello's D string, bowed at its middle with 1 N at 0.5 m/s. It sticks for half of each period and slips back for the other.

You learn that the same code serves acoustics, and to read a periodic run.
"""

import stickslip as ss

run = ss.simulate("bowed-string-slab")
string = run.problem.body
period = 2 * string.two_way_time
print(f"period {1e3 * period:.3f} ms, which is {1 / period:.1f} Hz")
print(run.events[["start", "duration", "peak_rate"]].iloc[2:6].round(5).to_string())

# %%
# Slip and stick last equally long, each one two-way travel time, and slip is twice as fast as the bow.

starts = run.events.start.iloc[2:].diff().dropna()
print(f"from slip to slip {1e3 * starts.mean():.3f} ms")

figure = run.plot(0.0, 4 * period)
