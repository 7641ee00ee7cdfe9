"""
How hard may a bow press?
=========================

A bowed string sounds as it should where it slips once in each period, as Helmholtz found. Schelleng gave the forces between which
it does: with more than ``2 Z v / (beta D)`` the corner of the wave no longer frees the string, and with less than
``Z^2 v / (2 R beta^2 D)`` the string slips more often. Z is the impedance of the string, R that of its ends, v the rate of the bow,
beta its place, and D the fall of friction from rest to fast slip. Here the string itself is asked, at 7 places and 13 forces.

You learn to set up a string bowed anywhere, and to compare a rule of thumb with exact runs.
"""

import matplotlib.pyplot as plt
import numpy as np

import stickslip as ss

Z, LENGTH, PITCH, RATE, ENDS = 0.55, 0.69, 146.8, 0.05, 12.0
SPEED, REST, FAST = 2.0 * LENGTH * PITCH, 1.2, 0.35
law = ss.friction.FromExpression("0.35 + 0.4*exp(-v/v1) + 0.45*exp(-v/v2)", {"v1": "10 mm/s", "v2": "100 mm/s"})


def regular(beta, force):
    """Return the share of the gaps between slips that last one period, after 20 periods of 40."""
    one, other = ([share * LENGTH] for share in (beta, 1.0 - beta))
    string = [Z / SPEED], [SPEED]
    body = ss.TwoSlabs(one, *string, other, *string, force, driver_impedance=ENDS, other_driver_impedance=ENDS, sides="joined")
    run = ss.simulate(ss.Problem(body, law, pull_rate=RATE, initial_load=FAST * force), 40.0 / PITCH, max_events=160)
    gaps = np.diff(run.events.start[run.events.start > 20.0 / PITCH]) * PITCH
    return float(np.mean(np.abs(gaps - 1.0) < 0.03)) if run.status.ok and len(gaps) else 0.0


places = 1.0 / np.array([20, 16, 12, 10, 8, 6, 5])
forces = np.geomspace(0.1, 1.6, 13)
share = np.array([[regular(beta, force) for beta in places] for force in forces])
largest = 2.0 * Z * RATE / (places * (REST - FAST))
smallest = Z**2 * RATE / (2.0 * ENDS * places**2 * (REST - FAST))
for n in (0, 3, 6):
    good = forces[share[:, n] > 0.5]
    found = f"{good.min():.2f} to {good.max():.2f} N" if len(good) else "none"
    print(f"bow at 1/{1 / places[n]:.0f}: Schelleng {smallest[n]:.2f} to {largest[n]:.2f} N, found {found}")

# %%
# Dark cells slip once in each period. The largest force is Schelleng's, or somewhat below it. The smallest is above his: his
# string has rounded corners, and here, where waves stay sharp, the contact slips in bursts long before the ends have taken that
# much energy away.

figure, axes = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
image = axes.pcolormesh(places, forces, share, shading="nearest", cmap="Blues", vmin=0.0, vmax=1.0)
axes.plot(places, largest, color="black", label="Schelleng's largest force")
axes.plot(places, smallest, color="black", linestyle="--", label="Schelleng's smallest force")
axes.set(
    xscale="log", yscale="log", xlabel="place of the bow / length of the string", ylabel="force of the bow (N)", ylim=(0.09, 1.8)
)
axes.set_xticks(places, [f"1/{1 / beta:.0f}" for beta in places], minor=False)
axes.minorticks_off()
axes.set_yticks([0.1, 0.2, 0.5, 1.0], ["0.1", "0.2", "0.5", "1"])
axes.legend(loc="upper right")
figure.colorbar(image, label="share of slips one period apart")
