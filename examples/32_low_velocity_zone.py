"""
A low-velocity zone makes pulses
================================

A soft layer along a fault sends waves back long before they return from the driver. The fault of the paper then slips more than
once; how often, and how far, depends on the layer's wave speed and on its share of the travel time.

You learn to describe a body of layers, and to vary them.
"""

import matplotlib.pyplot as plt
import numpy as np

import stickslip as ss

SPEED, TRAVEL = 3500.0, 10e3 / 3500.0
law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha="1 s/m")


def faulted(contrast, share):
    """Return a slab with a softer layer at the contact: its wave speed over that behind it, and its share of the travel time."""
    soft = contrast * SPEED
    body = ss.LayeredSlab([soft * share * TRAVEL, SPEED * (1.0 - share) * TRAVEL], [2800.0] * 2, [soft, SPEED], "100 MPa")
    return ss.Problem(body, law, pull_rate=1e-12, initial_excess=0.0)


contrasts = np.array([0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0])
shares = np.array([0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5])
slips, total = np.zeros((len(shares), len(contrasts)), int), np.zeros((len(shares), len(contrasts)))
for i, share in enumerate(shares):
    for j, contrast in enumerate(contrasts):
        run = ss.simulate(faulted(contrast, share), "35 s")
        slips[i, j], total[i, j] = len(run.events), run.slip(35.0)
print(f"uniform: {slips[0, -1]} slip of {total[0, -1]:.2f} m; at half the speed and a fifth of the time: {slips[3, 2]}, together")
print(f"{total[3, 2]:.2f} m; at most {slips.max()} slips; {total.min():.1f} to {total.max():.1f} m")

# %%
# Numbers are slips within 35 s, colours what they add up to.

figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
image = axes.imshow(total, origin="lower", aspect="auto", cmap="cividis")
middle = 0.5 * (total.min() + total.max())
for (i, j), count in np.ndenumerate(slips):
    axes.text(j, i, str(count), ha="center", va="center", color="black" if total[i, j] > middle else "white")
axes.set_xticks(range(len(contrasts)), [f"{one:g}" for one in contrasts])
axes.set_yticks(range(len(shares)), [f"{one:g}" for one in shares])
axes.set_xlabel("wave speed of the layer / that of the rock behind it")
axes.set_ylabel("share of the layer in the travel time")
figure.colorbar(image, label="slip of all events (m)")
