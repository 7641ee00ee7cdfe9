"""
Seismograms
===========

What would instruments record inside the slab of Figure 5? Three stations between the contact and the driver: the pulses pass
each of them on the way up, and again, with the opposite sign, on the way down.

You learn to sample a run, and to hand it to the tools of seismologists.
"""

import tempfile
from pathlib import Path

import numpy as np
from matplotlib import pyplot

import stickslip as ss
from stickslip.solution.files.sampling import sample

run = ss.simulate("fig5-slab-reconstructed")
slab = run.problem.body
times = np.arange(0.0, 12.0, 0.01)
figure, axes = pyplot.subplots(figsize=(6.8, 4.4), layout="constrained")
stations = [1e3, 4e3, 7e3]
for place in stations:
    velocity = run.field(place, times).velocity
    axes.plot(times, place / 1e3 + 0.12 * velocity, linewidth=0.9)
    arrival = times[np.argmax(velocity > 1e-3)]
    print(f"{place / 1e3:.0f} km: first arrival {arrival:.2f} s, expected {place / slab.wave_speed:.2f} s")

axes.set(xlabel="time (s)", ylabel="distance from the contact (km)", title="Particle velocity at three stations")

# %%
# An export for other programs is one call: on-fault time series as in the SCEC/USGS rupture benchmarks. ``sample`` gives what a
# station records at evenly spaced times, for ObsPy and other libraries: displacement, velocity and shear stress.

station = sample(run, 100.0, x=4e3)
print(f"the second station moves at up to {station.slip_rate.max():.3f} m/s")

with tempfile.TemporaryDirectory() as folder:
    path = run.to_scec(Path(folder) / "fig5.txt", sampling_rate=100.0)
    lines = path.read_text().splitlines()
print("\n".join(line for line in lines if not line.startswith("#"))[:140])
