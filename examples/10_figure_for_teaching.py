"""
A figure for teaching
=====================

Why does a slab slip for exactly 2h/c? One picture says it: distance from the contact against time, with the wave that the
contact sends, its reflection at the driver, and what moves and is stressed in each of the three triangles.

You learn to read the field at any place and time, without a grid, and to draw a figure of your own from it.
"""

import numpy as np
from matplotlib import pyplot

import stickslip as ss

slab = ss.ElasticSlab(density="2800 kg/m^3", wave_speed="3500 m/s", thickness="10 km", normal_stress="100 MPa")
law = ss.friction.Coulomb(static=0.8, dynamic=0.5)
run = ss.simulate(ss.Problem(slab, law, pull_rate="1 mm/year", initial_excess=0.0), "6 s")

# %%
# Under Coulomb friction the contact slips at (static - dynamic) S/Z. The wave carries this velocity and the friction of slip;
# the rigid driver stops the velocity and doubles the change of stress.

x, t = np.linspace(0.0, 10e3, 201), np.linspace(0.0, 6.0, 241)
field = run.field(x, t[:, None])
figure, axes = pyplot.subplots(figsize=(6.8, 4.2), layout="constrained")
image = axes.pcolormesh(t, x / 1e3, field.stress.T / 1e6, cmap="YlOrRd", vmin=0.0, vmax=110.0)
figure.colorbar(image, label="shear stress (MPa)")

drop = (law.static - law.dynamic) * slab.normal_stress
places = {"ahead of the wave": (1.0, 8e3), "behind the wave": (2.9, 3e3), "behind its reflection": (4.7, 8e3)}
closed_forms = ((0.0, 80.0), (drop / slab.impedance, 50.0), (0.0, 20.0))
for (name, (time, place)), (rate, stress) in zip(places.items(), closed_forms, strict=True):
    at = run.field(place, time)
    axes.text(time, place / 1e3, f"{name}\n{abs(at.velocity):.2f} m/s, {at.stress / 1e6:.0f} MPa", ha="center", va="center")
    print(f"{name:21} {abs(at.velocity):.4f} m/s, {at.stress / 1e6:.3f} MPa; closed form {rate:.4f} m/s, {stress:.0f} MPa")

axes.annotate("arrest, 2h/c", (slab.two_way_time, 0.0), (4.0, 1.2), arrowprops={"arrowstyle": "->"})
axes.set(xlabel="time (s)", ylabel="distance from the contact (km)", title="A slab is stopped by its own wave")
