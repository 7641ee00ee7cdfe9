#!/usr/bin/env bash
# pyuff 2.5.8 writes a binary function (dataset 58b of universal files) in mode "overwrite" as an empty file: its text is written,
# the file is opened again for the bytes, and again for the closing line, each time from empty. What stays is one line, "    -1",
# without an error or a warning. In mode "add" all is there, and so are functions as text in both modes.
# A sample that is missing (NaN) is written as 0 in every mode, as if it had been measured, and infinity as 1.8e308.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "pyuff==2.5.8" "numpy==2.4.6"
cd "$folder"
"$folder/venv/bin/python" - <<'END'
import importlib.metadata
from pathlib import Path

import numpy as np
import pyuff

time = 0.1 * np.arange(8)
shear = np.array([5.0, 5.1, np.nan, 5.3, 5.4, 5.5, 5.6, 5.7])
exponents = ("len_unit_exp", "force_unit_exp", "temp_unit_exp")
axes = {"abscissa": (17, "Time", "s"), "ordinate": (13, "Force", "kN"), "orddenom": (0, "NONE", "NONE"), "z_axis": (0, "NONE", "NONE")}


def function(binary: int) -> dict:
    """Return a function of time as pyuff takes it: single precision is not asked for, and the spacing is even."""
    found = {"type": 58, "binary": binary, "func_type": 1, "rsp_node": 1, "rsp_dir": 3, "ref_node": 1, "ref_dir": 1}
    found |= {f"id{k}": "NONE" for k in range(1, 6)} | {"id1": "shear", "rsp_ent_name": "cell", "ref_ent_name": "NONE"}
    found |= {"ord_data_type": 4, "abscissa_spacing": 1, "ver_num": 0, "load_case_id": 0, "z_axis_value": 0.0}
    for axis, (kind, label, unit) in axes.items():
        found |= {f"{axis}_spec_data_type": kind, f"{axis}_axis_lab": label, f"{axis}_axis_units_lab": unit}
        found |= {f"{axis}_{one}": 0 for one in exponents}
    return found | {"x": time.copy(), "data": shear.copy()}


print("pyuff", importlib.metadata.version("pyuff"))
sizes, values = {}, {}
for binary in (0, 1):
    for mode in ("overwrite", "add"):
        path = Path(f"{mode}{binary}.uff")
        pyuff.UFF(str(path)).write_sets(function(binary), mode=mode)
        sizes[binary, mode] = path.stat().st_size
        sets = pyuff.UFF(str(path)).get_set_types() if sizes[binary, mode] > 100 else []
        values[binary, mode] = pyuff.UFF(str(path)).read_sets()["data"][:4].tolist() if len(sets) else None
        print("binary" if binary else "text  ", f"{mode:9}", sizes[binary, mode], "bytes, data", values[binary, mode])
assert sizes[1, "overwrite"] == 7, sizes
assert Path("overwrite1.uff").read_bytes() == b"    -1\n"
assert min(size for key, size in sizes.items() if key != (1, "overwrite")) > 800, sizes
assert all(found == [5.0, 5.1, 0.0, 5.3] for key, found in values.items() if key != (1, "overwrite")), values
print("as described")
END
