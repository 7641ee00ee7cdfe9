"""Ways to damage the files of `fuzz_files`, by chance or by hand with checksums that fit."""

from __future__ import annotations

import json
import shutil
from contextlib import suppress
from pathlib import Path

import h5py
import numpy as np

from stickslip.extensions.sweeps.results.layout import SWEEP_FORMAT
from stickslip.foundation import netcdf_file

BLOCK = 512
"""Number of bytes that are overwritten or exchanged."""
RECORDS = ("lvm", "las", "uff", "txt")
"""Suffixes of records in formats of text."""
ODD = (None, -1, 0, 10**30, 1e300, float("nan"), True, "", "x", "a\n\x1b[31m", [], {}, [[]], {"a": 1}, "[" * 20_000)
"""Values that are put into metadata."""


def copied(kind: str, whole: Path, folder: Path) -> list[Path]:
    """Copy the files of a kind; return those that are to be damaged."""
    if kind in ("store", "metadata"):
        shutil.copytree(whole / "map.zarr", folder / "map.zarr")
        return sorted(path for path in (folder / "map.zarr").glob("zarr.json" if kind == "metadata" else "**/*") if path.is_file())
    if kind in ("csv", "nc"):
        for path in (whole / kind).iterdir():
            shutil.copy(path, folder / path.name)
        return sorted(folder.iterdir())
    if kind in RECORDS:
        shutil.copy(whole / f"record.{kind}", folder / f"record.{kind}")
        return [folder / f"record.{kind}"]
    shutil.copy(whole / "run.nc", folder / "run.nc")
    return [folder / "run.nc"]


def damage(path: Path, rng: np.random.Generator, *, may_vanish: bool) -> str:
    """Change a file at random; return how."""
    content = bytearray(path.read_bytes())
    size = max(len(content), 1)
    how = str(rng.choice(["flip", "flip", "flip", "flips", "cut", "longer", "block", "swap", "folder", *["gone"] * may_vanish]))
    begin, other = (int(rng.integers(size)) for _ in range(2))
    if how in ("flip", "flips"):
        for place in rng.integers(size, size=1 if how == "flip" else 8) if content else []:
            content[place] ^= 1 << int(rng.integers(8))
    elif how == "cut":
        del content[begin:]
    elif how == "longer":
        content += rng.bytes(BLOCK)
    elif how == "block":
        content[begin : begin + BLOCK] = rng.choice([bytes(BLOCK), rng.bytes(BLOCK)])[: len(content) - begin]
    elif how == "swap":
        width = min(BLOCK, size - max(begin, other), abs(begin - other))
        content[begin : begin + width], content[other : other + width] = (
            content[other : other + width],
            content[begin : begin + width],
        )
    path.write_bytes(content)
    if how in ("gone", "folder"):
        path.unlink()
    if how == "folder":
        path.mkdir()
    return how


def edit(path: Path, rng: np.random.Generator) -> str:
    """Change one number of one table, its shape, or an attribute, and give the file a checksum that fits."""
    path.write_bytes(path.read_bytes()[: -netcdf_file.SEAL])
    with h5py.File(path, "r+") as file:
        names = [name for name in file if name.startswith(("engine_", "history_")) and isinstance(file[name], h5py.Dataset)]
        name = str(rng.choice([name for name in names if file[name].dtype.kind in "if" and file[name].size]))
        table = file[name]
        how = str(rng.choice(["number", "number", "number", "longer", "gone", "attribute"]))
        if how == "number":
            place = tuple(int(rng.integers(length)) for length in table.shape)
            odd = (
                [-1, 0, 1, 2, 7, 10**6, 2**62, -(2**62)] if table.dtype.kind == "i" else [-1.0, 0.0, 1e300, np.inf, -np.inf, np.nan]
            )
            table[place] = odd[int(rng.integers(len(odd)))]
        elif how == "attribute":
            name = str(rng.choice(list(file.attrs)))
            file.attrs[name] = [-1, np.nan, "x", 10**12, ""][int(rng.integers(5))]
        else:
            values = table[...]
            del file[name]
            if how == "longer":
                file.create_dataset(name, data=np.concatenate([values, values]))
    netcdf_file.seal(path)
    return f"{how} of {name}"


def edit_metadata(path: Path, store: Path, rng: np.random.Generator) -> str:
    """Give one entry of a file of metadata an odd value, or remove it, and write its checksum anew."""
    whole = json.loads(path.read_text(encoding="utf-8"))
    place, names = whole, []
    while True:
        keys = list(place) if isinstance(place, dict) else list(range(len(place)))
        key = keys[int(rng.integers(len(keys)))]
        names.append(str(key))
        if not isinstance(place[key], dict | list) or not place[key] or rng.random() < 0.2:
            break
        place = place[key]
    if rng.random() < 0.2:
        del place[key]
    else:
        place[key] = ODD[int(rng.integers(len(ODD)))]
    with suppress(KeyError, TypeError, AttributeError):
        whole["attributes"]["digest"] = SWEEP_FORMAT.digest_of(whole["attributes"])
        for name, known in whole["consolidated_metadata"]["metadata"].items():
            (store / name / "zarr.json").write_text(json.dumps(known), encoding="utf-8")
    path.write_text(json.dumps(whole), encoding="utf-8")
    return f"edit of {'.'.join(names)}"
