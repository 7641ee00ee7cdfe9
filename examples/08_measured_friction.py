"""
From measured points to a run
=============================

Measurements are noisy. A law through every point has a fold at almost every one of them, and a run would show the noise and
not the rock. Fit a law instead, or smooth the points.

You learn to fit, to smooth, and to see what either does to uniqueness.
"""

import numpy as np
from matplotlib import pyplot

import stickslip as ss

slab = ss.ElasticSlab(density="2800 kg/m^3", wave_speed="3500 m/s", thickness="10 km", normal_stress="100 MPa")
truth = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
rates = np.linspace(0.0, 10.0, 200)
noise = 0.01 * np.random.default_rng(7).standard_normal(rates.size)
points = ss.friction.Points.read({"v (m/s)": rates, "mu": truth.coefficient(0.0, rates) + noise})

fitted = ss.friction.fit(points, "hyperbolic-rate")
curve = ss.friction.smooth(points)
print(fitted)
print(curve)

# %%
# The run needs nothing but the law. The slip rate of the first event is (80 MPa - S mu)/Z, and follows the fit to its
# uncertainty.

figure, axes = pyplot.subplots(figsize=(6.4, 4.0), layout="constrained")
axes.plot(rates, points.friction, ".", color="0.7", label="measured")
peaks = {}
for name, law in {"true law": truth, "fitted": fitted.law, "smoothed": curve.law}.items():
    problem = ss.Problem(slab, law, pull_rate="0.05 m/year", initial_excess=0.0)
    peaks[name] = ss.simulate(problem, "12 s").events.peak_rate[0]
    print(f"{name:9} {len(ss.uniqueness(problem).folds)} fold, first event at {peaks[name]:.3f} m/s")
    axes.plot(rates, law.coefficient(0.0, rates), label=name)

axes.set(xlabel="slip rate (m/s)", ylabel="friction coefficient", title="Noisy points, and two laws made from them")
axes.legend()
