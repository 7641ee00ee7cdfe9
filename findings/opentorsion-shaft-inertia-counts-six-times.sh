#!/usr/bin/env bash
# openTorsion 0.3.2: a shaft that is given by its stiffness k and its moment of inertia I turns with 6 I. The documentation calls I the
# moment of inertia of the shaft; the mass matrix is I times (2 1; 1 2), whose sum is 6 I, while a shaft that is given by its sizes gets
# rho J L/6 there, whose sum is rho J L, and is right. So the same shaft, given both ways, has two inertias, and its first frequency of
# torsion between fixed and free is sqrt(6) too low the second way. Lengths and diameters are in mm, moduli and densities in SI. The
# remedy: give I/6, or the sizes.
#
# Usage: findings/opentorsion-shaft-inertia-counts-six-times.sh [PYTHON]   (makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${1:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "opentorsion==0.3.2" "numpy==2.4.6"
"$folder/venv/bin/python" -W ignore - <<'END'
import math
from importlib.metadata import version

import numpy as np
from opentorsion.elements.shaft_element import Shaft

LENGTH, OUTER, INNER, MODULUS, DENSITY = 2.0, 0.127, 0.10861, 79.3e9, 7850.0  # m, m, m, Pa, kg/m^3

print("openTorsion", version("opentorsion"))
area_moment = math.pi * (OUTER**4 - INNER**4) / 32.0
inertia, stiffness = DENSITY * area_moment * LENGTH, MODULUS * area_moment / LENGTH
by_sizes = Shaft(0, 1, 1e3 * LENGTH, 1e3 * OUTER, 1e3 * INNER, G=MODULUS, rho=DENSITY)
by_inertia = Shaft(0, 1, k=stiffness, I=inertia)
together = np.ones(2)
counts = {}
for name, shaft in (("by its sizes", by_sizes), ("by k and I", by_inertia)):
    counts[name] = together @ shaft.M() @ together / inertia
    frequency = math.sqrt(shaft.K()[1, 1] / shaft.M()[1, 1])
    exact = math.sqrt(stiffness / (inertia / 3.0))
    print(f"{name}: turns with {counts[name]:.6f} times rho J L; one end fixed, {frequency / exact:.6f} times the frequency of one element")
assert abs(by_sizes.K()[0, 0] / stiffness - 1.0) < 1e-12
assert abs(counts["by its sizes"] - 1.0) < 1e-12 and abs(counts["by k and I"] - 6.0) < 1e-12
print("as described")
END
