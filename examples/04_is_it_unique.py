"""
Is the answer unique?
=====================

A slab without contact mass must balance its load at every instant: Z v + S mu(v) = load. If friction falls faster with slip
rate than Z v rises, several slip rates do. The set of all of them is the set K of the paper's Figure 3.

You learn to ask which slip rates solve the contact equation, where the folds are, and how far the law is from being unique.
"""

import numpy as np
from matplotlib import pyplot

import stickslip as ss

slab = ss.ElasticSlab(density="2800 kg/m^3", wave_speed="3500 m/s", thickness="10 km", normal_stress="100 MPa")
rates, curves = np.linspace(0.0, 6.0, 600), {}
for alpha in (0.1, 0.196, 1.0):
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=alpha)
    contact = ss.uniqueness(ss.Problem(slab, law, initial_excess=0.0))
    curves[f"alpha = {alpha:g} s/m: {contact.regime}"] = contact.g(rates) / 1e6
    print(f"alpha = {alpha:g} s/m: {contact.regime}, at 70 MPa {contact.admissible(70e6).round(4)} m/s")

# %%
# The loop ends with alpha = 1 s/m. Its lower fold is where rest and fast slip meet when the load falls; the closed forms of the
# paper are those of :doc:`/theory/uniqueness`.

fold = contact.folds[0]
ratio = np.sqrt(1.0 / contact.critical_value)
print(f"critical alpha {contact.critical_value:g} s/m; lower fold at {fold.rate:.6f} m/s and {fold.load / 1e6:.6f} MPa")
print(f"closed form: {ratio - 1:.6f} m/s and {30 + 9.8 * (2 * ratio - 1):.6f} MPa")

figure, axes = pyplot.subplots(figsize=(6.4, 4.2), layout="constrained")
for label, curve in curves.items():
    axes.plot(rates, curve, label=label)
axes.plot(fold.rate, fold.load / 1e6, "ko", label="lower fold")
axes.axhline(70.0, color="0.6", linewidth=0.8, zorder=0)
axes.set(xlabel="slip rate v (m/s)", ylabel="Z v + S mu(v) (MPa)", title="One load, one slip rate or three")
axes.legend()
