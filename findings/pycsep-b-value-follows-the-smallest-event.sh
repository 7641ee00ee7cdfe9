#!/usr/bin/env bash
# pycsep 0.8.0 takes the smallest magnitude of a catalogue for its completeness, and has no argument that says another one. Of
# 100 000 events with b = 1 from magnitude 4 on, one more event of magnitude 2.4 turns b from 1.004 into 0.214. The standard error
# beside it is negative, whatever the catalogue: -0.0032 here; its size is right while the smallest event is complete.
# `catalog.filter("magnitude >= 4")` before `get_bvalue` gives 1.004 again.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "pycsep==0.8.0" "numpy==2.4.6"
cd "$folder"
"$folder/venv/bin/python" - <<'END_OF_PYTHON'
import importlib.metadata
import warnings

warnings.simplefilter("ignore")
import numpy as np
from csep.core.catalogs import CSEPCatalog

BINS = np.arange(0.0, 10.0, 0.1)
steps = np.floor(np.random.default_rng(1).exponential(10.0 / np.log(10.0), 100_000))
complete = 4.0 + steps / 10.0
exact = np.log1p(1.0 / steps.mean()) / (0.1 * np.log(10.0))


def catalogue(magnitudes):
    """Return a catalogue with a second between events, all in one place."""
    rows = [(str(n), 1_600_000_000_000 + 1000 * n, 0.0, 0.0, 10.0, float(one)) for n, one in enumerate(magnitudes)]
    return CSEPCatalog(data=rows)


print("pycsep", importlib.metadata.version("pycsep"), "b of the geometric law of bins:", exact)
found = {}
for small in ([], [2.4]):
    found[bool(small)] = catalogue(np.append(complete, small)).get_bvalue(BINS)
    print("with one small event" if small else "complete            ", [float(one) for one in found[bool(small)]])
mended = catalogue(np.append(complete, 2.4)).filter("magnitude >= 4").get_bvalue(BINS)
print("filtered before     ", [float(one) for one in mended])
assert abs(found[False][0] - exact) < 1e-9
assert abs(mended[0] - exact) < 1e-9
assert 0.2 < found[True][0] < 0.25
assert found[False][1] < 0.0 and found[True][1] < 0.0
print("as described")
END_OF_PYTHON
