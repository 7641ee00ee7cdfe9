#!/usr/bin/env bash
# MuJoCo 4.0.0: dry friction of a joint (`frictionloss`) never holds. A mass of 1 kg under half the force that breaks it away slides at
# 0.53 mm/s for ever, at any time step; at a tenth of it at 0.11 mm/s. The rate is in proportion to the force, so that no force below
# friction leaves the mass at rest, and a spring that is pulled more slowly than this is followed without any stick. A slide that
# stops by friction is right: v^2/(2 mu g) within 1e-5. The cause is that the constraint is soft: with solimpfriction="0.9999 0.9999
# 0.001" on the joint the same mass slides at 0.5 micrometres per second, and solreffriction="0.004 1" divides by five.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "mujoco==4.0.0" "numpy==2.4.6"
"$folder/venv/bin/python" - <<'END'
import mujoco

MODEL = """
<mujoco>
  <option timestep="{step}" gravity="0 0 0"/>
  <worldbody><body><joint name="x" type="slide" axis="1 0 0" frictionloss="1" {joint}/><geom type="sphere" size=".1" mass="1"/></body></worldbody>
  <actuator><motor joint="x"/></actuator>
</mujoco>
"""


def moved(force: float, rate: float = 0.0, step: float = 1e-3, joint: str = "", time: float = 10.0) -> tuple[float, float]:
    """Return place (m) and rate (m/s) of the mass after a time (s) under a force (N) that friction of 1 N holds."""
    model = mujoco.MjModel.from_xml_string(MODEL.format(step=step, joint=joint))
    data = mujoco.MjData(model)
    data.ctrl[0], data.qvel[0] = force, rate
    for _ in range(round(time / step)):
        mujoco.mj_step(model, data)
    return float(data.qpos[0]), float(data.qvel[0])


print("MuJoCo", mujoco.__version__)
rates = {force: moved(force)[1] for force in (0.1, 0.5, 0.9)}
for force, rate in rates.items():
    print(f"{force} N on friction of 1 N: {rate:.4e} m/s after 10 s")
for step in (2e-3, 1e-4):
    rate = moved(0.5, step=step, time=2.0)[1]
    print(f"0.5 N, time step {step} s: {rate:.4e} m/s")
    assert abs(rate / rates[0.5] - 1.0) < 1e-6
hard = moved(0.5, joint='solimpfriction="0.9999 0.9999 0.001"')[1]
quick = moved(0.5, joint='solreffriction="0.004 1"')[1]
print(f"0.5 N, a harder constraint: {hard:.2e} m/s; a quicker one: {quick:.4e} m/s")
thrown = moved(0.0, rate=1.0, step=1e-4, time=3.0)[0]
print(f"thrown at 1 m/s: stops after {thrown:.6f} m; v^2 m/(2 F) is 0.5 m")
assert all(abs(rate / force - rates[0.5] / 0.5) < 1e-6 * rate / force for force, rate in rates.items())
assert abs(rates[0.5] - 5.2778e-4) < 1e-8
assert abs(hard - 5e-7) < 1e-9 and abs(quick * 5.0 / rates[0.5] - 1.0) < 1e-6
assert abs(thrown - 0.5) < 1e-5
print("as described")
END
