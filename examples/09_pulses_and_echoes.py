"""
Pulses and echoes
=================

Inside the slab of Figure 5. Each pulse of slip sends a wave towards the driver, which reflects it with the opposite sign. When
the first wave is back, after 2h/c, it unloads the contact for good.

You learn to draw what happens away from the contact, and to relate a pulse to the law's wavelength.
"""

import math

import stickslip as ss

run = ss.simulate("fig5-slab-reconstructed")
figure = run.plot.field()

# %%
# Under a constant load the slip rate of a law that oscillates with slip is periodic, and its period has a closed form. The
# pulses of the run follow it up to the first echo.

problem = run.problem
law, slab = problem.friction, problem.body
load = problem.strength + problem.initial_excess - law.mean * slab.normal_stress
swing = law.amplitude * slab.normal_stress
period = 2 * math.pi * slab.impedance / (law.wavenumber * math.sqrt(load**2 - swing**2))
pulses = run.pulses()
print(pulses[["start", "slip", "peak_rate"]].round(4).to_string())
print(f"period in closed form {period:.4f} s; between the pulses {pulses.start.diff().iloc[2]:.4f} s")
print(f"slip of a pulse {pulses.slip.iloc[1]:.5f} m; wavelength of the law {2 * math.pi / law.wavenumber:.5f} m")
