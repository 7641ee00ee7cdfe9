#!/usr/bin/env bash
# ddeint 0.3.0 (SciPy 1.17.1): the answer depends on the times at which it is asked for. What is delayed is interpolated by straight
# lines between the times of the answer, and is held constant beyond the last of them. For y' = -y(t - 1) with y = 1 before, whose
# solution is a sum of powers, 11 times up to 10 end at -0.101 and 21 times at 0.0552, where 0.0202411 is right; two times end at -9.
# The error falls with the square of the interval and nothing warns. The remedy is an interval far below the delay: 1001 times give
# 0.0202444.
#
# Usage: findings/ddeint-answer-depends-on-output-times.sh [PYTHON]   (makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${1:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "ddeint==0.3.0" "scipy==1.17.1" "numpy==2.4.6"
"$folder/venv/bin/python" - <<'END'
import math
from importlib.metadata import version

import numpy as np
from ddeint import ddeint


def exact(time: float) -> float:
    """Return the solution at a time (delays) by the method of steps."""
    return sum((-1) ** k * (time - k + 1) ** k / math.factorial(k) for k in range(math.floor(time) + 2))


print("ddeint", version("ddeint"))
found = {}
for count in (2, 11, 21, 101, 1001):
    answer = ddeint(lambda y, t: -y(t - 1.0), lambda t: 1.0, np.linspace(0.0, 10.0, count))
    found[count] = float(np.ravel(answer[-1])[0])
    print(f"{count:5} times: y(10) = {found[count]:.7f}; exact {exact(10.0):.7f}")
expected = {2: -9.0, 11: -0.1009770, 21: 0.0551960, 101: 0.0205720, 1001: 0.0202444}
assert all(abs(found[count] - value) < 2e-6 for count, value in expected.items())
assert abs(exact(10.0) - 0.0202411) < 1e-7
print("as described")
END
