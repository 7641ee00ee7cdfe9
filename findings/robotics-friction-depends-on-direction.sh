#!/usr/bin/env bash
# Friction that depends on the direction of sliding. A ball of 1 kg that cannot turn slides at 3 m/s on a floor with a coefficient of
# 0.5, along an axis and along the diagonal; what brakes it, divided by its weight, is the coefficient that it met.
#   MuJoCo 4.0.0    the default cone is a pyramid: 0.5 along the axis, 0.35 along the diagonal (0.5/sqrt(2) but for the bounce of a soft
#                   contact), and a ball that set out at 22.5 degrees is turned to 40 degrees. cone="elliptic" brakes by the same in all
#                   directions and does not turn, which is the remedy; a smaller time step is none.
#   dartpy 6.20.0   the two axes have a bound each: 0.5 along the axis, 0.7071 along the diagonal, 0.634 at 22.5 degrees, where the ball
#                   is turned onto the axis. At rest it holds 6.8 N along the diagonal, where it breaks away at 4.905 N along the axis.
# Isotropic friction of Coulomb brakes by 0.5 in every direction and turns nothing.
#
# Usage: findings/robotics-friction-depends-on-direction.sh [PYTHON]   (makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${1:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "mujoco==4.0.0" "dartpy==6.20.0" "numpy==2.4.6"
cat > "$folder/in_mujoco.py" <<'END'
import math

import mujoco

MODEL = """
<mujoco>
  <option timestep="{step}" cone="{cone}" gravity="0 0 -9.81"/>
  <worldbody>
    <geom type="plane" size="9 9 1" friction="0.5 0 0"/>
    <body pos="0 0 .1">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size=".1" mass="1" friction="0.5 0 0"/>
    </body>
  </worldbody>
</mujoco>
"""


def met(degrees: float, cone: str, step: float = 1e-3) -> tuple[float, float]:
    """Return the coefficient that a ball met, and its direction (degrees) after 0.3 s."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(cone=cone, step=step))
    data = mujoco.MjData(model)
    for _ in range(round(1.0 / step)):
        mujoco.mj_step(model, data)
    begun = 3.0 * math.cos(math.radians(degrees)), 3.0 * math.sin(math.radians(degrees))
    data.qvel[:2] = begun
    for _ in range(round(0.3 / step)):
        mujoco.mj_step(model, data)
    lost = math.hypot(begun[0] - data.qvel[0], begun[1] - data.qvel[1])
    return lost / 0.3 / 9.81, math.degrees(math.atan2(data.qvel[1], data.qvel[0]))


print("MuJoCo", mujoco.__version__)
for step in (1e-3, 1e-4):
    for cone in ("pyramidal", "elliptic"):
        found = {degrees: met(degrees, cone, step) for degrees in (0.0, 22.5, 45.0)}
        for degrees, (coefficient, direction) in found.items():
            print(f"{cone}, step {step} s, at {degrees} degrees: {coefficient:.3f}, then at {direction:.1f} degrees")
        assert abs(found[0.0][0] - 0.5) < 0.03
        if cone == "pyramidal":
            assert abs(found[45.0][0] - 0.5 / math.sqrt(2.0)) < 0.02 and abs(found[22.5][1] - 40.0) < 1.0
        else:
            assert max(one[0] for one in found.values()) - min(one[0] for one in found.values()) < 1e-4
            assert abs(found[22.5][1] - 22.5) < 0.01
END
cat > "$folder/in_dart.py" <<'END'
import math

import dartpy as dart
import numpy as np


def floor_and_ball() -> tuple:
    """Return a world, the skeleton of a ball that cannot turn, and its body."""
    world = dart.simulation.World()
    world.setTimeStep(1e-3)
    world.setGravity([0.0, 0.0, -9.81])
    ground = dart.dynamics.Skeleton("ground")
    node = ground.createWeldJointAndBodyNodePair()[1].createShapeNode(dart.dynamics.BoxShape([60.0, 60.0, 1.0]))
    node.createCollisionAspect()
    node.createDynamicsAspect().setFrictionCoeff(0.5)
    node.setRelativeTranslation([0.0, 0.0, -0.5])
    ball = dart.dynamics.Skeleton("ball")
    body = ball.createTranslationalJointAndBodyNodePair()[1]
    shape = body.createShapeNode(dart.dynamics.SphereShape(0.1))
    shape.createCollisionAspect()
    shape.createDynamicsAspect().setFrictionCoeff(0.5)
    inertia = dart.dynamics.Inertia()
    inertia.setMass(1.0)
    body.setInertia(inertia)
    world.addSkeleton(ground)
    world.addSkeleton(ball)
    ball.setPositions([0.0, 0.0, 0.1 - 1e-5])
    for _ in range(500):
        world.step()
    return world, ball, body


def along(degrees: float) -> np.ndarray:
    return np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees)), 0.0])


def met(degrees: float) -> tuple[float, float]:
    """Return the coefficient that a ball met, and its direction (degrees) after 0.3 s."""
    world, ball, _ = floor_and_ball()
    ball.setVelocities(3.0 * along(degrees))
    for _ in range(300):
        world.step()
    end = np.array(ball.getVelocities())
    return float(np.linalg.norm(3.0 * along(degrees) - end) / 0.3 / 9.81), math.degrees(math.atan2(end[1], end[0]))


def pushed(degrees: float, force: float) -> float:
    """Return the speed (m/s) after 1 s under a force (N)."""
    world, ball, body = floor_and_ball()
    for _ in range(1000):
        body.setExtForce(force * along(degrees))
        world.step()
    return float(np.linalg.norm(ball.getVelocities()))


print("dartpy", dart.__version__)
found = {degrees: met(degrees) for degrees in (0.0, 22.5, 45.0)}
for degrees, (coefficient, direction) in found.items():
    print(f"at {degrees} degrees: {coefficient:.4f}, then at {direction:.1f} degrees")
assert abs(found[0.0][0] - 0.5) < 1e-4 and abs(found[45.0][0] - math.sqrt(0.5)) < 1e-4
assert abs(found[22.5][0] - 0.6342) < 1e-3 and abs(found[22.5][1]) < 1e-6
speeds = {(degrees, force): pushed(degrees, force) for degrees, force in ((0.0, 5.0), (45.0, 6.8), (45.0, 8.0))}
for (degrees, force), speed in speeds.items():
    print(f"pushed by {force} N at {degrees} degrees: {speed:.3g} m/s after 1 s")
assert speeds[0.0, 5.0] > 0.09 and speeds[45.0, 6.8] < 1e-6 and speeds[45.0, 8.0] > 0.5
END
"$folder/venv/bin/python" "$folder/in_mujoco.py"
"$folder/venv/bin/python" "$folder/in_dart.py"
echo "as described"
