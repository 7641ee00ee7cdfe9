"""
Slip triggered by a passing wave
================================

A soft layer on bedrock rests just below its strength. A wave comes up through the bedrock; each of its two crests triggers
7 cm of slip, which the layer's own echo stops.

You learn to load a slab through a driver of finite impedance, and why a passing wave can start slip.
"""

import stickslip as ss

run = ss.simulate("stress-pulse-slab")
print(run.events[["start", "duration", "slip", "peak_rate"]].round(4).to_string())
print(f"two-way travel time {run.problem.body.two_way_time:.4f} s")

# %%
# Rest and slip are both possible between the two folds. That is why a wave can bring the contact from one to the other.

contact = ss.uniqueness(run.problem)
low, high = contact.window
strength = run.problem.strength
print(f"{contact.regime}: several slip rates between {(strength + low) / 1e6:.3f} and {(strength + high) / 1e6:.3f} MPa")

figure = run.plot()
