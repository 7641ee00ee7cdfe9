"""
A block and a slab under one law
================================

The comparison of the paper's Figure 5: a rigid block on a spring and an elastic slab, both under friction that oscillates
with slip. The block slips once, smoothly. The slab slips in three pulses, until the reflected wave stops it.

You learn to compare runs side by side.
"""

import stickslip as ss

both = ss.studies.compare("fig5-block-reconstructed-omega", "fig5-slab-reconstructed")
print(both.table.set_index("name")[["pulses", "slip", "peak_rate", "shocks"]].round(4).to_string())

# %%
# A block has forces and a slab stresses; the figure therefore shows friction divided by the normal load.

figure = both.plot()
