#!/usr/bin/env bash
# Drake 1.58.0: a plant with a time step, which is the usual choice, knows one coefficient of friction. A ball of 1 kg that cannot turn,
# on a floor with 0.8 at rest and 0.4 in sliding, should hold any push up to 7.848 N; it slides off from 3.92 N on, as the documentation of
# the class says and no run does: after 1 s under 4.7 N it slides at 0.777 m/s, as with 0.4 alone. At 3 N it creeps at 1.2 mm/s (the
# tolerance of stiction is 1 mm/s). A plant in continuous time (time step 0) keeps both: 7.8 N creep at 0.9 mm/s, 7.9 N slide off. The same
# plant, set down on the floor without any penetration and pushed at once, slides off from less: it has no normal force yet when the
# push begins, and once it slides 0.4 is all there is. So let it settle first.
#
# Usage: findings/drake-static-friction-is-lost-in-discrete-time.sh [PYTHON]   (Python 3.12 or later; makes and removes an environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python=${1:-python3.12}
"$python" -c "" 2> /dev/null || export PYENV_VERSION=$(pyenv latest 3.12)
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "drake==1.58.0"
"$folder/venv/bin/python" - <<'END'
from importlib.metadata import version

from pydrake.all import (
    AbstractValue,
    AddMultibodyPlantSceneGraph,
    Box,
    CoulombFriction,
    DiagramBuilder,
    ExternallyAppliedSpatialForce,
    LeafSystem,
    PrismaticJoint,
    RigidTransform,
    Simulator,
    SpatialForce,
    SpatialInertia,
    Sphere,
)


class Push(LeafSystem):
    """A horizontal force (N) from a time (s) on."""

    def __init__(self, body, force, begin):
        super().__init__()
        self.body, self.force, self.begin = body, force, begin
        empty = AbstractValue.Make([ExternallyAppliedSpatialForce()])
        self.DeclareAbstractOutputPort("push", lambda: empty, self.write, {self.time_ticket()})

    def write(self, context, output):
        push = ExternallyAppliedSpatialForce()
        push.body_index, push.p_BoBq_B = self.body.index(), [0.0, 0.0, 0.0]
        push.F_Bq_W = SpatialForce([0.0, 0.0, 0.0], [self.force if context.get_time() >= self.begin else 0.0, 0.0, 0.0])
        output.set_value([push])


def speed(step, force, settled=1.0, static=0.8):
    """Return the speed (m/s) after 1 s under a force (N)."""
    builder = DiagramBuilder()
    plant, _ = AddMultibodyPlantSceneGraph(builder, step)
    dry = CoulombFriction(static, 0.4)
    plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform([0.0, 0.0, -0.5]), Box(40.0, 40.0, 1.0), "floor", dry)
    carrier = plant.AddRigidBody("carrier", SpatialInertia.SolidSphereWithMass(1e-4, 0.01))
    ball = plant.AddRigidBody("ball", SpatialInertia.SolidSphereWithMass(1.0, 0.1))
    plant.RegisterCollisionGeometry(ball, RigidTransform(), Sphere(0.1), "ball", dry)
    height = plant.AddJoint(PrismaticJoint("height", plant.world_frame(), carrier.body_frame(), [0.0, 0.0, 1.0]))
    place = plant.AddJoint(PrismaticJoint("place", carrier.body_frame(), ball.body_frame(), [1.0, 0.0, 0.0]))
    plant.Finalize()
    plant.set_stiction_tolerance(1e-3)
    plant.set_penetration_allowance(1e-3)
    push = builder.AddSystem(Push(ball, force, settled))
    builder.Connect(push.get_output_port(), plant.get_applied_spatial_force_input_port())
    simulator = Simulator(builder.Build())
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    height.set_translation(context, 0.1)
    simulator.AdvanceTo(settled + 1.0)
    return place.get_translation_rate(context)


print("Drake", version("drake"))
discrete = {(force, static): speed(1e-3, force, static=static) for force, static in ((3.0, 0.8), (4.7, 0.8), (4.7, 0.4))}
for (force, static), found in discrete.items():
    print(f"time step 1 ms, 0.4 in sliding, {static} at rest, {force} N: {found:.6f} m/s after 1 s")
assert discrete[4.7, 0.8] == discrete[4.7, 0.4] and abs(discrete[4.7, 0.8] - 0.777) < 0.01
assert abs(discrete[3.0, 0.8] - 1.2e-3) < 1e-4
continuous = {force: speed(0.0, force) for force in (7.8, 7.9)}
for force, found in continuous.items():
    print(f"continuous time, {force} N: {found:.6f} m/s after 1 s")
assert continuous[7.8] < 1e-3 and continuous[7.9] > 3.9
at_once = {force: speed(0.0, force, settled=0.0) for force in (3.0, 6.0)}
for force, found in at_once.items():
    print(f"continuous time, not settled, {force} N: {found:.6f} m/s after 1 s")
assert at_once[3.0] < 1e-3 and at_once[6.0] > 1.9
print("as described")
END
