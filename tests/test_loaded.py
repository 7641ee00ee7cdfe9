"""What a command loads: as few lines of the package as were measured, no library that it does not need, and below the engine no
engine and no compiler.
"""

from __future__ import annotations

import subprocess
import sys
import sysconfig
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from benchmarks.loaded import THINGS, lines_of, loaded

import stickslip

PACKAGE = Path(stickslip.__file__).parent
MOST = {"simulate": 25_000, "uniqueness": 15_000}
"""Largest number of lines of the package that may be loaded. Most of them are those of the engine's loop, of the law and of the
body: what few runs need is imported when it is used. Uniqueness loads kernels since its proofs are compiled (13 600 before),
and the kinds of drivers, by which a body says how it is ended."""
BELOW = ("foundation", "friction", "problem", "contact")
"""Rooms below the engine, all of whose files must do without it and without the compiler."""
ABOVE = (
    *("solution.accessors", "solution.evaluation", "solution.solution", "solution.window"),
    *("run.options", "run.progress", "run.run_loop", "run.simulate", "run.solver"),
)
"""Modules above it that a run by another solver loads."""

TYPER = {"annotated_doc", "shellingham", "typer", "typing_extensions"}
"""What every command loads."""
NUMPY = TYPER | {"numpy", "numpy.polynomial", "numpy.typing"}
SHOWN = NUMPY | {"rich"}
ENGINE = SHOWN | {"llvmlite", "platformdirs", "numpy.ma"}
"""What machine code needs; `numpy.unique` asks whether arrays are masked."""
FILES = {"h5py", "tomli_w"}
"""What writes a run; h5py alone reads it."""
MATPLOTLIB = {
    *("PIL", "contourpy", "cycler", "dateutil", "fontTools", "kiwisolver", "matplotlib", "mpl_toolkits", "packaging"),
    *("platformdirs", "pyparsing", "six"),
}
XARRAY = {
    *("xarray", "pandas", "dateutil", "packaging", "pint", "flexcache", "flexparser", "platformdirs", "pytz", "six"),
    *("dask", "cloudpickle", "importlib_metadata", "jinja2", "lazy_importer", "markupsafe", "psutil", "tblib", "tlz", "toolz"),
    *("yaml", "zipp", "_cyutility", "numpy.ma", "numpy.random", "scipy"),
}
"""What xarray imports; dask, with all from the second line on, only where it is installed, but never its arrays."""
ZARR = {"zarr", "donfig", "fsspec", "google_crc32c", "msgpack", "numcodecs"}
MAY_LOAD = {
    "--help": TYPER,
    "--version": TYPER,
    "run --help": NUMPY,
    "new slab": NUMPY,
    "new --list": SHOWN,
    "check fig6-slab": ENGINE,
    "run fig6-slab": ENGINE,
    "run fig6-slab --figure run.png": ENGINE | MATPLOTLIB,
    "run fig6-slab --out run.nc": ENGINE | FILES,
    "show run.nc": ENGINE | {"h5py"},
    "run --resume run.nc --duration 20": ENGINE | FILES,
    "sweep fig6-slab --vary friction.alpha=0.05..0.4:5": ENGINE | XARRAY | ZARR | {"tomli_w"},
}
"""The libraries that a command may load, by what is typed; of numpy and scipy their parts, but for those that they load themselves.

A name that is added here costs every command of its line the import of that library: `python -X importtime -m stickslip run
fig6-slab` says how long. Better is to import it in the function that needs it.
"""


def libraries_in(modules: dict[str, str]) -> set[str]:
    """Return the libraries of which some modules are, each with its file; those of a bare interpreter are none."""
    place, themselves = sysconfig.get_paths()["purelib"], by_themselves()
    found = set()
    for name, file in modules.items():
        top, _, inside = name.partition(".")
        if file.startswith(place) and name not in bare():
            part = inside.partition(".")[0]
            apart = top in ("numpy", "scipy") and name not in themselves and not part.startswith("_")
            found.add(f"{top}.{part}" if apart else top)
    return found


@cache
def by_themselves() -> dict[str, str]:
    return loaded("import numpy, scipy")


@cache
def bare() -> dict[str, str]:
    return loaded("pass")


@pytest.fixture(scope="module")
def folder_of_runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("runs")
    stickslip.simulate("fig6-slab").to_netcdf(folder / "run.nc")
    return folder


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("typed", MAY_LOAD)
def test_a_command_loads_no_library_that_it_does_not_need(typed: str, folder_of_runs: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(folder_of_runs)
    more = libraries_in(loaded(f"from stickslip.cli.main import main; main({typed.split()})")) - MAY_LOAD[typed]
    assert not more, f"`python -X importtime -m stickslip {typed}` shows what loads them"


def test_parts_of_numpy_and_scipy_are_told_from_what_these_load_themselves() -> None:
    assert libraries_in(loaded("import numpy.fft, scipy.fft")) >= {"numpy", "numpy.fft", "scipy", "scipy.fft", "scipy.special"}
    assert not [name for name in libraries_in(loaded("import scipy, typer")) if name.startswith(("numpy.", "scipy."))]


@pytest.mark.parametrize("thing", MOST)
def test_a_run_loads_no_more_lines_than_were_measured(thing: str) -> None:
    lines = lines_of(loaded(THINGS[thing]))
    assert sum(lines.values()) <= MOST[thing], f"`python -m benchmarks.loaded {thing} --files` lists them"


def test_lines_of_the_package_alone_are_counted(tmp_path: Path) -> None:
    for name, text in (("own.py", "1\n2\n3\n"), ("owner.py", "1\n")):
        (tmp_path / name).write_text(text, encoding="utf-8")
    files = {"own": str(tmp_path / "own.py"), "own.part": str(tmp_path / "own.py"), "owner": str(tmp_path / "owner.py")}
    assert lines_of(files, "own") == {"own": 3, "own.part": 3}


def test_what_stands_below_the_engine_loads_neither_it_nor_the_compiler() -> None:
    """Module by module in one process; the first that brings one of the two is named."""
    there = [path.relative_to(PACKAGE) for room in BELOW for path in sorted((PACKAGE / room).rglob("*.py"))]
    files = [path.with_suffix("") for path in there if "compiler" not in path.parts]  # it is imported when the package is built
    modules = [".".join(path.parts).removesuffix(".__init__") for path in files] + list(ABOVE)
    code = f"""
import importlib, sys
for name in {modules}:
    importlib.import_module("stickslip." + name)
    brought = [one for one in sys.modules if one == "numba" or one.startswith("stickslip.engine")]
    if brought:
        sys.exit(f"{{name}} loads {{brought[0]}}")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr.splitlines()[-1]
