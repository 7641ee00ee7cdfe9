"""
A friction law of your own
==========================

A law is a Python function of slip ``u``, slip rate ``v`` or both. Here friction weakens with slip over some micrometres and
strengthens with slip rate, on a granite slab 10 cm thick.

You learn to hand a function to the package, to change its parameters, and to see what the contact makes of it.
"""

import numpy as np
from matplotlib import pyplot

import stickslip as ss


def weakening(u, v, peak=0.8, steady=0.6, distance="3 um", viscosity="0.5 s/m"):
    """Return the friction coefficient."""
    return steady + (peak - steady) * np.exp(-u / distance) + viscosity * v


slab = ss.ElasticSlab(density="2700 kg/m^3", wave_speed="3000 m/s", thickness="10 cm", normal_stress="5 MPa")
figure, (left, right) = pyplot.subplots(1, 2, figsize=(9.0, 3.8), layout="constrained")
for distance in ("1 um", "3 um", "9 um"):
    law = ss.friction.FromFunction(weakening, distance=distance, counts="path")
    problem = ss.Problem(slab, law, pull_rate="1 mm/s", initial_excess="10 kPa")
    run = ss.simulate(problem, "0.4 ms")
    event = run.events.iloc[0]
    print(f"distance {distance}: slips {1e6 * event.slip:6.3f} um at up to {event.peak_rate:.4f} m/s")
    time, rate = run.curve("slip_rate")
    left.plot(1e3 * time, rate, label=f"distance = {distance}")
    slip = np.linspace(0.0, run.slip(run.duration), 200)
    right.plot(1e6 * slip, law.coefficient(slip), label=f"distance = {distance}")

left.set(xlabel="time (ms)", ylabel="slip rate (m/s)", title="the slab")
right.set(xlabel="slip (um)", ylabel="friction coefficient at rest", title="the law")
right.legend()

# %%
# The function is called once, with symbols; the formula that it records is compiled like those of the built-in laws.

print(law.expression)
print(ss.uniqueness(problem).summary)
