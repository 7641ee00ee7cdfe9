#!/usr/bin/env bash
# hvsrpy 2.1.0 reads three files of PEER, one a component, and takes the one whose azimuth is nearest to north for the north component,
# and the farthest for the east. Azimuths 045 and 315 are equally far from north: then both are the first file, and the second one is
# never used, without a warning. The spectral ratio of two horizontals is that of one, whatever the order of the files.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "hvsrpy==2.1.0" "obspy==1.5.1" "numpy==2.4.6" "ipython==9.7.0" "setuptools<81"
cd "$folder"
"$folder/venv/bin/python" - <<'END'
from importlib.metadata import version
from pathlib import Path

import hvsrpy
import numpy as np

time = 0.01 * np.arange(1000)


def write(name: str, motion: np.ndarray) -> str:
    """Write a file of PEER whose component is `name`."""
    cells = [f"{one:15.7E}" for one in motion]
    lines = ["made for a test", f"Test, 1/1/2000, Station, {name}", "VELOCITY TIME SERIES IN UNITS OF CM/S", "NPTS=   1000, DT=   .0100 SEC,"]
    lines += ["".join(cells[i : i + 5]) for i in range(0, len(cells), 5)]
    Path(f"{name}.VT2").write_text("\n".join(lines) + "\n")
    return f"{name}.VT2"


print("hvsrpy", version("hvsrpy"))
vertical = write("UP", np.cos(time))
found = {}
for pair in (("045", "315"), ("045", "135"), ("000", "090")):
    files = [write(name, (i + 1) * np.sin(time)) for i, name in enumerate(pair)]
    (record,) = hvsrpy.read([[*files, vertical]])
    found[pair] = tuple(round(float(np.abs(one.amplitude).max()), 3) for one in (record.ns, record.ew))
    print("azimuths", pair, "written with peaks 1 and 2, read as north", found[pair][0], "and east", found[pair][1])
assert found["000", "090"] == found["045", "135"] == (1.0, 2.0)
assert found["045", "315"] == (1.0, 1.0)
print("as described")
END
