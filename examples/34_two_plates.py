"""
Two plates rub, and their travel times decide
=============================================

A plate of steel, 48 mm thick, is pulled over a plate of granite. Both ring after each slip. Where the travel times of the plates
are as 1 to 1, 1 to 2 or 1 to 3, their echoes come back together, and the contact slips in large events, one like the other;
elsewhere the echoes come one by one, and each of them starts or ends a small slip. Here the granite is 36 to 144 mm thick.

You learn to set up two bodies that both give way, and to compare the events of many runs.
"""

import matplotlib.pyplot as plt
import numpy as np

import stickslip as ss

law = ss.friction.ExponentialStribeck(static=0.7, dynamic=0.6, rate="1 mm/s")
STEEL = ["48 mm"], ["7850 kg/m^3"], ["3200 m/s"]
GRANITE = ["2650 kg/m^3"], ["3000 m/s"]


def later_slips(thickness):
    """Return the slips (um) of all events but the first, which starts from an even stress, within 30 ms."""
    body = ss.TwoSlabs(*STEEL, [f"{thickness} mm"], *GRANITE, "5 MPa", travel_time_error=0.01)
    run = ss.simulate(ss.Problem(body, law, pull_rate="1 mm/s", initial_excess=0.0), "30 ms")
    return run.events.slip.to_numpy()[1:] * 1e6


thicknesses = np.arange(36, 145, 3)
slips = [later_slips(thickness) for thickness in thicknesses]
for thickness in (45, 60, 90, 111, 135):
    found = slips[list(thicknesses).index(thickness)]
    print(f"{thickness:3d} mm: {len(found):3d} slips, {np.median(found):.2f} um in the median, {found.max():.2f} um at most")

# %%
# Each dot is an event. The travel time of the steel is that of 45 mm of granite.

figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
for thickness, found in zip(thicknesses, slips, strict=True):
    axes.plot(np.full(len(found), thickness), found, "o", color="#0072b2", markersize=3, alpha=0.4, markeredgewidth=0)
for ratio in (1, 2, 3):
    axes.axvline(45 * ratio, color="0.8", zorder=0)
    axes.text(45 * ratio, 1.01, f"1 : {ratio}", ha="center", va="bottom", transform=axes.get_xaxis_transform())
axes.set(yscale="log", xlabel="thickness of the granite (mm)", ylabel="slip of an event (μm)")
axes.set_yticks([0.01, 0.1, 1.0, 10.0], ["0.01", "0.1", "1", "10"])
