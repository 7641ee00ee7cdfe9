"""
Sliding block on shaken ground
==============================

How far does a slope move in an earthquake? Newmark's answer is a rigid block that slips downhill whenever the ground accelerates
by more than the slope can bear. Here it is solved exactly, beside the same mass as a soil column that deforms while it slides.

You learn to move the ground under a contact, and to read a run in the words of slope stability.
"""

import pandas as pd
from matplotlib import pyplot

import stickslip as ss

G = 9.80665
runs = {"rigid": ss.simulate("sliding-block-shaken"), "deformable": ss.simulate("sliding-slab-shaken")}

# %%
# The yield acceleration is what the ground needs to make the mass slip: strength less the pull of gravity, over the mass. Slip is
# relative to the ground, and never uphill, so its last value is the permanent displacement.


def in_words(run: ss.Solution) -> dict[str, float]:
    """Return what a geotechnical engineer asks of a run."""
    problem, end = run.problem, float(run.breaks[-1])
    mass = problem.body.density * problem.body.thickness if problem.body.has_waves else problem.body.mass
    return {
        "yield acceleration (g)": (problem.strength - problem.load) / mass / G,
        "peak ground acceleration (g)": max(abs(one) for one in problem.ground_acceleration.values) / G,
        "slips": len(run.events),
        "peak relative velocity (m/s)": run.events.peak_rate.max(),
        "permanent displacement (m)": float(run.slip(end)),
    }


table = pd.DataFrame({name: in_words(run) for name, run in runs.items()})
print(table.round(4).to_string())

# %%
# The record has a period of 0.67 s, near that of the column, 4 h/c = 0.5 s: the column swings, and slides more than twice as far as
# the rigid block. The stiffer a column is, the closer it comes to the block.

record = runs["rigid"].problem.ground_acceleration
figure, (ground, rate, slip) = pyplot.subplots(3, figsize=(6.4, 6.4), sharex=True, layout="constrained")
ground.plot(record.times, [one / G for one in record.values], color="0.3")
for sign in (-1, 1):
    ground.axhline(sign * table.loc["yield acceleration (g)", "rigid"], color="0.3", lw=0.8, ls=":")
for name, run in runs.items():
    times, rates = run.curve("slip_rate", 0.0, run.breaks[-1])
    rate.plot(times, rates, label=name)
    slip.plot(*run.curve("slip", 0.0, run.breaks[-1]), label=name)
ground.set(ylabel="ground acceleration (g)", title="A mass that slides on shaken ground", xlim=(0.0, run.breaks[-1]))
rate.set(ylabel="relative velocity (m/s)")
slip.set(ylabel="displacement (m)", xlabel="time (s)")
slip.legend()
