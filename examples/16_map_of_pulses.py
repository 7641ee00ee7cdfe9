"""
A map over two parameters
=========================

How many pulses does the slab of Figure 5 make? The number grows with its thickness and with the excess of the load over the
strength. A sweep runs 3600 slabs in compiled code, on all cores.

You learn to vary parameters, to draw a map, and to let a search follow the line where an answer changes.
"""

import numpy as np

import stickslip as ss

vary = {"initial.excess": np.linspace(65e3, 68e3, 60), "body.thickness": np.linspace(4e3, 16e3, 60)}
found = ss.sweep("fig5-slab-reconstructed", vary, quantities=["pulses"])
print(dict(found.sizes))
print(f"from {found.pulses.min():.0f} to {found.pulses.max():.0f} pulses")
figure = ss.figures.plot_sweep(found, "pulses")

# %%
# Where only the boundary matters, a coarse grid and repeated halving of the cells around it need fewer members. Here it is the
# critical curve of the slab of Figure 6, alpha S = Z/(0.8 - 0.3), which is known in closed form.

coarse = {"friction.alpha": np.linspace(0.05, 2.0, 9), "body.normal_stress": np.linspace(50e6, 200e6, 7)}
regimes = ss.refine("fig6-slab", coarse, "irregular", depth=3)
product = regimes["friction.alpha"] * regimes["body.normal_stress"]
critical = 9.8e6 / 0.5
print(f"{regimes.sizes['member']} members, where a grid of the finest cells has 65 x 49 = 3185")
print(f"all members agree with the closed form: {bool(((product > critical) == (regimes.irregular == 1)).all())}")

regime_figure = ss.figures.plot_sweep(regimes, "irregular")
