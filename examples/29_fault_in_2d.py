"""
A fault in 2D
=============

Slip begins in a nucleus of 8 km, runs along the contact in both directions, and stops at barriers: the paper's slab with a contact
on which slip travels. The echo from the driver returns after 5.71 s and arrests it.

You learn to let load and barriers vary along the contact, to read when the front passes, and to write an animation.
"""

import tempfile
from pathlib import Path

import numpy as np

import stickslip as ss

slab = ss.ElasticSlab(density=2800, wave_speed=3500, thickness="10 km", normal_stress="100 MPa")
law = ss.friction.LinearSlipWeakening(static=0.7, dynamic=0.5, distance=0.4)
fault = ss.PlanarSlab(
    ss.Problem(slab, law, initial_load="60 MPa"),
    nodes=256,
    length="40 km",
    along={"initial.load": lambda y: np.where(np.abs(y) < 4e3, 71e6, 60e6)},
    barrier=lambda y: np.abs(y) > 18e3,
    replicas=False,
)
run = ss.simulate(fault, 8.0)
print(run)
run.plot()

# %%
# Away from the nucleus the front runs at nearly the wave speed, 3.5 km/s, as fronts do that are fed more energy than they consume.

outside = (fault.y > 6e3) & (fault.y < 16e3)
print(f"front: {np.median(run.rupture_speed[outside]) / 1e3:.2f} km/s")

# %%
# The animation shows slip rate and slip along the contact. For a plane (3D) it shows maps.

with tempfile.TemporaryDirectory() as folder:
    film = run.plot.animation(Path(folder) / "fault.gif", 0.0, 3.0, frames=20)
    print(f"{film.name}: {film.stat().st_size / 1e3:.0f} kB")
