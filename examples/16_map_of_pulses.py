"""
A map over two parameters
=========================

How many pulses does the slab of Figure 5 make? The number grows with its thickness and with the excess of the load over the
strength. A sweep runs 3600 slabs in compiled code, on all cores.

You learn to vary parameters, to draw a map, and to compare it with a closed form.
"""

import numpy as np

import stickslip as ss

vary = {"initial.excess": np.linspace(65e3, 68e3, 60), "body.thickness": np.linspace(4e3, 16e3, 60)}
found = ss.sweep("fig5-slab-reconstructed", vary, quantities=["pulses"])
print(dict(found.sizes))
print(f"from {found.pulses.min():.0f} to {found.pulses.max():.0f} pulses")
figure = ss.figures.plot_sweep(found, "pulses")

# %%
# Where the slab of Figure 6 has several slip rates to choose from is known in closed form: its critical curve is
# alpha S = Z/(0.8 - 0.3). No member of a map of the regimes lies on the wrong side of it.

vary = {"friction.alpha": np.linspace(0.05, 2.0, 100), "body.normal_stress": np.linspace(50e6, 200e6, 100)}
regimes = ss.sweep("fig6-slab", vary, quantities=["irregular"])
product = regimes["friction.alpha"] * regimes["body.normal_stress"]
agree = (product > 9.8e6 / 0.5) == (regimes.irregular == 1)
print(f"{int(agree.sum())} of {agree.size} members agree with the closed form")

regime_figure = ss.figures.plot_sweep(regimes, "irregular")
