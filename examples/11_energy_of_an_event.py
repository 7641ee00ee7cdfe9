"""
Where the energy goes
=====================

Each pulse of the slab of Figure 5 turns elastic energy into heat and into a wave. The heat is taken from the friction law, so
the balance is a test of the run.

You learn to draw an energy balance, and to read stress drop, fracture energy and efficiency of an event.
"""

import stickslip as ss

run = ss.simulate("fig5-slab-reconstructed")
event = run.energetics().iloc[0]
for name in ("elastic", "kinetic", "heat", "fracture", "waves"):
    print(f"{name:<10}{event[name] / 1e6:8.3f} MJ/m2")
print(f"efficiency {event.efficiency:.3f}, apparent stress {event.apparent_stress / 1e6:.2f} MPa")
print(f"imbalance {abs(event.balance) / event.heat:.0e} of the heat")

# %%
# A pulse slips over half a wavelength of the law until friction is smallest; its fracture energy is S a pi / omega.

law, normal = run.problem.friction, run.problem.body.normal_stress
print(f"fracture energy of a pulse {run.pulses().fracture.iloc[1] / 1e6:.4f} MJ/m2")
print(f"closed form                {normal * law.amplitude * 3.141592653589793 / law.wavenumber / 1e6:.4f} MJ/m2")

figure = run.plot.energy(0.0, 5.0)
