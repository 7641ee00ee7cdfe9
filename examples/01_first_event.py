"""
First event
===========

The elastic slab of the paper's Figure 6: it slips at once, at a constant rate, and is stopped by its own wave when that
returns from the driver.

You learn to describe a slab and a friction law, to run them, to read the tables of slip events and of shocks, and to draw
the run.
"""

import stickslip as ss

slab = ss.ElasticSlab(density="2800 kg/m^3", wave_speed="3500 m/s", thickness="10 km", normal_stress="100 MPa")
law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
problem = ss.Problem(slab, law, pull_rate="0.05 m/year", initial_excess=0.0)
run = ss.simulate(problem, duration="12 s")

# %%
# The load begins exactly at the static strength (``initial_excess=0``) and the driver pulls, so the contact slips at 0 s. The
# table has one row for each slip event; everything is in SI.

print(run.events[["start", "end", "slip", "peak_rate", "traction_drop"]].round(4).to_string())

# %%
# The slip rate jumps twice: at the start, and when the wave that left at the start comes back. That takes the two-way travel
# time 2h/c.

print(run.shocks[["time", "cause", "rate_before", "rate_after"]].round(4).to_string())
print(f"two-way travel time: {slab.two_way_time:.4f} s")

# %%
# Values at any time are exact to the tolerance of the run. At a shock there are two limits; ``side`` chooses one.

print(f"{run.slip(3.0):.4f} m and {run.slip_rate(3.0):.4f} m/s after 3 s")
print(f"slip rate at 0 s: {run.slip_rate(0.0, side='left'):.1f} before, {run.slip_rate(0.0):.4f} m/s after")

figure = run.plot()
