#!/usr/bin/env bash
# A damping ratio D means two things in programs for the response of soil. pyStrata 0.5.4 takes the modulus G (sqrt(1 - 4 D^2) + 2 i D), whose
# size is G; PySeismoSoil 0.7.0 takes G (1 + 2 i D), whose size is G sqrt(1 + 4 D^2). At D = 0.1 a layer of 20 m with waves of 200 m/s on rigid
# rock has its first peak at 2.485 Hz and 6.308 times the motion of the rock in the one, at 2.510 Hz and 6.435 times in the other, and both
# agree with 1/|cos(w h/c)| for their own modulus; up to 10 Hz they differ by up to 6.7 %. pyStrata's constant COMP_MODULUS_MODEL = "seed" makes it
# the other. Damping that does not depend on frequency is no differential equation: programs in time damp by mass and stiffness, and a damping
# ratio is right there at one or two frequencies.
#
# Usage: findings/soil-damping-has-two-moduli.sh [PYTHON]   (makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${1:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "pystrata==0.5.4" "PySeismoSoil==0.7.0" "pandas==3.1.1" "numpy==2.4.6"
"$folder/venv/bin/python" -W ignore - <<'END'
from importlib.metadata import version

import numpy as np
import pystrata
from PySeismoSoil.helper_site_response import linear_tf

THICKNESS, SPEED, DENSITY, RATIO = 20.0, 200.0, 2000.0, 0.1
frequency = 0.005 * np.arange(1, 2000)


def closed(factor: complex) -> np.ndarray:
    """Return the motion of the surface over that of rigid rock, for a factor of the modulus."""
    return np.abs(1.0 / np.cos(2.0 * np.pi * frequency * THICKNESS / (SPEED * np.sqrt(factor))))


def by_pystrata(model: str) -> np.ndarray:
    """Return the same by pyStrata."""
    pystrata.site.COMP_MODULUS_MODEL = model
    soil = pystrata.site.SoilType("soil", DENSITY * 9.80665e-3, None, RATIO)
    rock = pystrata.site.SoilType("rock", DENSITY * 9.80665e-3, None, 0.0)
    profile = pystrata.site.Profile([pystrata.site.Layer(soil, THICKNESS, SPEED), pystrata.site.Layer(rock, 0.0, 2000.0)])
    solver = pystrata.propagation.LinearElasticCalculator()
    solver(pystrata.motion.Motion(frequency), profile, profile.location("outcrop", index=-1))
    ends = profile.location("within", index=-1), profile.location("outcrop", index=0)
    return np.abs(solver.calc_accel_tf(*ends))


def peak(curve: np.ndarray) -> tuple[float, float]:
    """Return frequency (Hz) and height of the first peak."""
    at = next(i for i in range(1, len(curve)) if curve[i] > curve[i + 1])
    return round(float(frequency[at]), 3), round(float(curve[at]), 3)


print("pyStrata", version("pystrata"), "PySeismoSoil", version("PySeismoSoil"))
default = by_pystrata(pystrata.site.COMP_MODULUS_MODEL)
profile = np.array([[THICKNESS, SPEED, RATIO, DENSITY, 1], [0.0, 2000.0, 1e-9, DENSITY, 0]])
found = linear_tf(profile, show_fig=False, freq_resolution=0.005, fmax=10.0)
other = found[6]
assert np.allclose(found[0], frequency)
for name, curve in (("pyStrata", default), ("PySeismoSoil", other)):
    print(f"{name}: first peak at {peak(curve)[0]} Hz, {peak(curve)[1]} times the rock")
apart = 100.0 * np.max(np.abs(other / default - 1.0))
print(f"largest difference up to 10 Hz: {apart:.1f} %")
assert abs(apart - 6.7) < 0.1
assert np.allclose(default, closed(np.sqrt(1.0 - 4.0 * RATIO**2) + 2j * RATIO), rtol=1e-6)
assert np.allclose(other, closed(1.0 + 2j * RATIO), rtol=1e-6)
assert np.allclose(by_pystrata("seed"), other, rtol=1e-6)
assert peak(default) == (2.485, 6.308) and peak(other) == (2.51, 6.435)
print("as described")
END
