#!/usr/bin/env bash
# SeismoStats 1.0.1 finds b of magnitudes in bins exactly: the logarithm of the geometric law, to rounding, and events below the
# completeness that is given change nothing. What it subtracts from magnitudes in bins is nothing: completeness is the middle of
# the first bin. Given as exact (delta_m=0), the same magnitudes give 1.13 instead of 1.00 without a word.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "seismostats==1.0.1" "numpy==2.4.6"
cd "$folder"
"$folder/venv/bin/python" - <<'END_OF_PYTHON'
import importlib.metadata

import numpy as np
from seismostats.analysis import ClassicBValueEstimator

steps = np.floor(np.random.default_rng(1).exponential(10.0 / np.log(10.0), 100_000))
complete = np.round(4.0 + steps / 10.0, 1)
exact = np.log1p(1.0 / steps.mean()) / (0.1 * np.log(10.0))
print("SeismoStats", importlib.metadata.version("seismostats"), "b of the geometric law of bins:", exact)
estimator = ClassicBValueEstimator()
estimator.calculate(complete, mc=4.0, delta_m=0.1)
alone, error = float(estimator.b_value), float(estimator.std)
estimator.calculate(np.append(complete, 2.4), mc=4.0, delta_m=0.1)
beside = float(estimator.b_value)
estimator.calculate(complete, mc=4.0, delta_m=0.0)
as_exact = float(estimator.b_value)
print("complete", alone, "standard error", error, "with one small event", beside, "as if not in bins", as_exact)
assert abs(alone - exact) < 1e-12
assert beside == alone
assert 0.003 < error < 0.0033
assert 1.1 < as_exact < 1.15
print("as described")
END_OF_PYTHON
