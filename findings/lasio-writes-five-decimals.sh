#!/usr/bin/env bash
# lasio 0.32 writes each number of a LAS file with five decimals, whatever its size: a slip rate of 1e-7 m/s is written as 0.00000,
# and 1.23456789e-3 as 0.00123, without a word. Times of a logger at 20 kHz, 50 us apart, come out in steps of 0.00005 and are
# unharmed; at 200 kHz every second one repeats. `write(..., fmt="%.9g")` keeps them.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "lasio==0.32" "numpy==2.4.6"
cd "$folder"
"$folder/venv/bin/python" - <<'END'
import lasio
import numpy as np

rates = [1e-7, 1.23456789e-3, 2e-6]
print("lasio", lasio.__version__)
las = lasio.LASFile()
las.append_curve("TIME", [0.0, 5e-6, 1e-5], unit="S")
las.append_curve("RATE", rates, unit="M/S", descr="slip rate")
las.write("usual.las", version=2.0)
las.write("kept.las", version=2.0, fmt="%.9g")
usual, kept = (lasio.read(name) for name in ("usual.las", "kept.las"))
print("written", rates)
print("usual  ", usual["RATE"].tolist(), "times", usual["TIME"].tolist())
print("%.9g   ", kept["RATE"].tolist(), "times", kept["TIME"].tolist())
assert usual["RATE"].tolist() == [0.0, 0.00123, 0.0]
assert len(set(usual["TIME"].tolist())) < 3
assert np.allclose(kept["RATE"], rates, rtol=1e-8)
print("as described")
END
