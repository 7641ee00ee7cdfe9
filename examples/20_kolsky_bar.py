"""
A friction test in a Kolsky bar
===============================

A torsional wave runs through an aluminium bar and twists a short steel tube against a disc. The contact accelerates in steps,
one for each round trip of the waves in the tube, to 4.94 m/s.

You learn to take a case of laboratory size: micrometres, microseconds, and a stress that arrives through a bar.
"""

import stickslip as ss

run = ss.simulate("kolsky-slab")
tube = run.problem.body
event = run.events.iloc[0]
print(f"round trip in the tube {1e6 * tube.two_way_time:.2f} us")
print(f"slip {1e3 * event.slip:.2f} mm at up to {event.peak_rate:.3f} m/s, from {1e6 * event.start:.1f} us")

# %%
# In steady sliding the bar carries what friction does not: the rate is (stress of the wave - friction)/impedance of the bar.

friction = run.problem.friction.dynamic * tube.normal_stress
print(f"steady slip rate {(68e6 - friction) / tube.driver_impedance:.3f} m/s")

figure = run.plot(0.0, 80e-6)
