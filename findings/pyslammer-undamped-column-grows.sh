#!/usr/bin/env bash
# pySLAMMER 0.2.3: the coupled analysis of a column that is not damped grows without bound. A column of 5 m with waves of 500 m/s (a
# period of 0.04 s) on rigid ground, shaken by 0.3 g at 1 Hz for 20 s, slides as a rigid block does, 3.53 m, and a little further; with
# samples every 10 ms it slides 127 m and every 5 ms 8e254 m, without a warning. Ten seconds more of shaking multiply that by 1e129. With
# samples every 2.5 ms the sum is 3.58 m, with a damping ratio of 0.5 % and 10 ms 8.75 m, with 1 % 3.59 m. So damp the column by 1 %
# or more, give the samples finely (20 in a period of the column), and compare with the rigid block, to which a stiff column tends.
#
# Usage: findings/pyslammer-undamped-column-grows.sh [PYTHON]   (Python 3.12 or later; makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python=${1:-python3.12}
"$python" -c "" 2> /dev/null || export PYENV_VERSION=$(pyenv latest 3.12)
"$python" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "pyslammer==0.2.3" "numpy==2.5.5"
"$folder/venv/bin/python" -W ignore - <<'END'
from importlib.metadata import version

import numpy as np
import pyslammer


def slides(interval: float, shaken: float, damping: float) -> tuple[float, float]:
    """Return what a column and a rigid block slide (m), shaken for a time (s), with samples at an interval (s)."""
    time = interval * np.arange(round((shaken + 2.0) / interval))
    motion = pyslammer.GroundMotion(np.where(time < shaken, 0.3 * np.sin(2.0 * np.pi * time), 0.0), interval, "made")
    column = pyslammer.Coupled(
        ky=0.1, ground_motion=motion, height=5.0, vs_slope=500.0, vs_base=1e9, damp_ratio=damping
    )
    return column.max_sliding_disp, pyslammer.RigidAnalysis(ky=0.1, ground_motion=motion).max_sliding_disp


print("pySLAMMER", version("pyslammer"))
cases = ((0.01, 20.0, 0.0), (0.005, 10.0, 0.0), (0.005, 20.0, 0.0), (0.0025, 20.0, 0.0), (0.01, 20.0, 0.005), (0.01, 20.0, 0.01))
found = {case: slides(*case) for case in cases}
for (interval, shaken, damping), (column, rigid) in found.items():
    print(f"every {1e3 * interval} ms, {shaken} s, damping {damping}: column {column:.4g} m, rigid block {rigid:.4g} m")
assert all(abs(rigid / (3.53 * shaken / 20.0) - 1.0) < 2e-3 for (_, shaken, _), (_, rigid) in found.items())
assert abs(found[0.01, 20.0, 0.0][0] / 126.5 - 1.0) < 0.01
assert found[0.005, 20.0, 0.0][0] > 1e250 and found[0.005, 10.0, 0.0][0] > 1e120
assert abs(found[0.0025, 20.0, 0.0][0] - 3.58) < 0.01
assert abs(found[0.01, 20.0, 0.005][0] - 8.75) < 0.02 and abs(found[0.01, 20.0, 0.01][0] - 3.59) < 0.01
print("as described")
END
