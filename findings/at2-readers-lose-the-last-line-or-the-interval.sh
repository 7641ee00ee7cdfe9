#!/usr/bin/env bash
# Two readers of AT2, the files of PEER's ground-motion databases. quakeio 0.1.21 and sgsim 1.4.0 read a file without its last line, so
# that up to five samples are lost, and do not compare their number with NPTS. sgsim also rounds the interval to a millisecond: a
# record of 400 Hz (0.0025 s) gets 0.003 s, so that its velocities and displacements are 1.2 and 1.44 times what they are. Neither
# says a word.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "quakeio==0.1.21" "sgsim==1.4.0" "numpy==2.4.6"
cd "$folder"
"$folder/venv/bin/python" - <<'END'
from importlib.metadata import version
from pathlib import Path

import numpy as np
from quakeio.parse.nga import read_nga
from sgsim.io.record_reader import Record

motion = 0.3 * np.sin(0.05 * np.arange(1003))
cells = [f"{one:15.7E}" for one in motion]
lines = ["made for a test", "Test, 1/1/2000, Station, 090", "ACCELERATION TIME SERIES IN UNITS OF G", "NPTS=   1003, DT=   .0025 SEC,"]
lines += ["".join(cells[i : i + 5]) for i in range(0, len(cells), 5)]
Path("a.AT2").write_text("\n".join(lines) + "\n")

print("quakeio", version("quakeio"), "sgsim", version("sgsim"))
read = np.asarray(read_nga("a.AT2"))
print("written 1003 samples, quakeio reads", len(read))
assert len(read) == 1000
assert np.allclose(read, motion[:1000], atol=1e-7)
record = Record(file="a.AT2", source="nga")
print("written 0.0025 s, sgsim reads", record.dt, "s and", len(record.ac), "samples")
assert record.dt == 0.003
assert len(record.ac) == 1000
print("as described")
END
