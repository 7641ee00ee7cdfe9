"""
Velocity steps in the laboratory
================================

The experiment by which friction was found to depend on rate and state: a rock slides steadily at 1 um/s, and the machine is
stepped to 10 and to 100 um/s and back. Friction jumps with the step and then evolves.

You learn to run rate-and-state friction and to drive a block with steps of the pull rate.
"""

import math

import stickslip as ss

run = ss.simulate("velocity-steps-block")
law = run.problem.friction
normal = run.problem.body.normal_force
for time, rate in ((199.0, "1 um/s"), (249.0, "10 um/s"), (509.0, "100 um/s")):
    print(f"steady friction at {rate:8}: {run.traction(time) / normal:.4f}")

# %%
# In steady sliding friction falls by (b - a) ln 10 for each factor of ten.

measured = (run.traction(199.0) - run.traction(249.0)) / normal
print(f"fall for a factor of ten {measured:.5f}, (b - a) ln 10 = {(law.b - law.a) * math.log(10):.5f}")

figure = run.plot(150.0, 600.0)
