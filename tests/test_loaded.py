"""What a run loads: as few lines of the package as were measured, and below the engine no engine and no compiler."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from benchmarks.loaded import THINGS, lines_of, loaded

import stickslip

PACKAGE = Path(stickslip.__file__).parent
MOST = {"simulate": 25_000, "uniqueness": 13_600}
"""Largest number of lines of the package that may be loaded; measured are 24 582 and 13 322. Most of them are those of the engine's
loop, of the law and of the body: what few runs need is imported when it is used."""
BELOW = ("foundation", "friction", "problem", "contact")
"""Rooms below the engine, all of whose files must do without it and without the compiler."""
ABOVE = (
    *("solution.accessors", "solution.evaluation", "solution.solution", "solution.window"),
    *("run.options", "run.progress", "run.run_loop", "run.simulate", "run.solver"),
)
"""Modules above it that a run by another solver loads."""


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
