#!/usr/bin/env bash
# OpenSeesPy 3.8.0.0: a sliding bearing that is driven by displacements has no slip rate, so that friction that depends on the rate
# stays at its slow value. A flat slider under 1000 N has a coefficient of 0.05 at rest and 0.15 when fast (0.15 - 0.1 exp(-50 v)); at
# 1 m/s it should resist with 150 N. Driven by a single-point displacement (`sp`), in a static or in a transient analysis, and driven by a
# ground motion that has only displacements, it resists with 50 N: the displacement is set, the velocity of the node stays 0, and no
# analysis says so. The remedy is a ground motion that has the velocity, too (`groundMotion` with -disp, -vel and -accel): 150 N. Ask
# nodeVel whether the node has the velocity that you meant.
#
# Usage: findings/opensees-driven-slider-has-no-rate.sh [PYTHON]   (Python 3.12; makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python=${1:-python3.12}
"$python" -c "" 2> /dev/null || export PYENV_VERSION=$(pyenv latest 3.12)
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "openseespy==3.8.0.0" "numpy==2.5.5"
"$folder/venv/bin/python" - 2> /dev/null <<'END'
from importlib.metadata import version

import openseespy.opensees as ops


def begin() -> None:
    """Make a slider between the ground, node 1, and node 2, and press it with 1000 N."""
    ops.wipe()
    ops.model("basic", "-ndm", 2, "-ndf", 3)
    ops.node(1, 0.0, 0.0)
    ops.node(2, 0.0, 0.0)
    ops.fix(1, 1, 1, 1)
    ops.fix(2, 0, 0, 1)
    ops.mass(2, 1.0, 1.0, 1e-9)
    ops.frictionModel("VelDependent", 1, 0.05, 0.15, 50.0)
    ops.uniaxialMaterial("Elastic", 1, 1e8)
    ops.uniaxialMaterial("Elastic", 2, 1e3)
    ops.element("flatSliderBearing", 1, 1, 2, 1, 1e6, "-P", 1, "-Mz", 2, "-orient", 0, 1, 0, -1, 0, 0)
    ops.timeSeries("Linear", 1)
    ops.pattern("Plain", 1, 1)
    ops.load(2, 0.0, -1000.0, 0.0)
    solve("static", 1.0)
    assert ops.analyze(1) == 0
    ops.loadConst("-time", 0.0)
    ops.wipeAnalysis()


def solve(kind: str, step: float) -> None:
    """Choose an analysis."""
    ops.constraints("Transformation")
    ops.numberer("Plain")
    ops.system("FullGeneral")
    ops.test("NormDispIncr", 1e-12, 50)
    ops.algorithm("Newton")
    if kind == "static":
        ops.integrator("LoadControl", step)
        ops.analysis("Static")
    else:
        ops.integrator("Newmark", 0.5, 0.25)
        ops.analysis("Transient")


def drive(way: str) -> tuple[float, float]:
    """Return the friction (N) and the velocity of the node (m/s) after 0.05 s at 1 m/s."""
    begin()
    ops.timeSeries("Linear", 2)
    if way.startswith("sp"):
        ops.pattern("Plain", 2, 2)
        ops.sp(2, 1, 1.0)
    else:
        ops.timeSeries("Constant", 3)
        ops.timeSeries("Constant", 4, "-factor", 0.0)
        ops.pattern("MultipleSupport", 2)
        ops.groundMotion(1, "Plain", "-disp", 2, *(("-vel", 3, "-accel", 4) if way.endswith("velocity") else ()))
        ops.imposedMotion(2, 1, 1)
    kind = "static" if way.endswith("static") else "transient"
    solve(kind, 1e-3)
    for _ in range(50):
        assert ops.analyze(1, *(() if kind == "static" else (1e-3,))) == 0
    assert abs(ops.nodeDisp(2, 1) - 0.05) < 1e-9
    return abs(ops.eleResponse(1, "force")[0]), ops.nodeVel(2, 1)


print("OpenSeesPy", version("openseespy"))
ways = ("sp, static", "sp, transient", "ground motion of displacement", "ground motion of displacement and velocity")
found = {way: drive(way) for way in ways}
for way, (friction, rate) in found.items():
    print(f"{way}: {friction:.3f} N, node at {rate:.3f} m/s; 150 N at 1 m/s are meant")
assert all(abs(friction - 50.0) < 1e-3 and rate == 0.0 for friction, rate in list(found.values())[:3])
assert abs(found[ways[3]][0] - 150.0) < 1e-3 and abs(found[ways[3]][1] - 1.0) < 1e-9
print("as described")
END
