"""The wheel that pip builds brings machine code, for the system where it was built; without it, it is for every system."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from pathlib import Path
from shutil import copy, copytree, ignore_patterns, rmtree
from zipfile import ZipFile

import pytest

import stickslip
from stickslip.foundation.code_key import SHIPPED
from stickslip.foundation.kernels.code import NAME
from tests.core.foundation.kernels.fresh import COMMAND

ROOT = Path(stickslip.__file__).parents[2]


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """A copy of all that a wheel is built from."""
    copytree(ROOT / "src", tmp_path / "tree/src", ignore=ignore_patterns("__pycache__", "*.egg-info"))
    for name in ("pyproject.toml", "hatch_build.py", "README.md", "LICENSE", ".gitignore"):
        copy(ROOT / name, tmp_path / "tree")
    return tmp_path / "tree"


def built(tree: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Build a wheel as pip does, without what PYTHONPATH says of this package."""
    settings = os.environ | {"STICKSLIP_CACHE_DIR": str(tree / "cache"), "PYTHONPATH": ""} | environment
    command = [sys.executable, "-m", "hatchling", "build", "-t", "wheel"]
    return subprocess.run(command, cwd=tree, capture_output=True, text=True, check=False, env=settings)


def wheel_in(tree: Path) -> Path:
    (path,) = (tree / "dist").iterdir()
    return path


def code_in(wheel: Path) -> set[str]:
    with ZipFile(wheel) as archive:
        return {name.removeprefix("stickslip/machine_code/") for name in archive.namelist() if "/machine_code/" in name}


def of_this_system() -> str:
    return f"py3-none-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


@pytest.mark.slow
def test_a_wheel_has_the_machine_code_and_is_for_this_system(tree: Path) -> None:
    done = built(tree)
    assert done.returncode == 0, done.stderr
    assert "is up to date" in done.stdout
    wheel = wheel_in(tree)
    assert wheel.name == f"stickslip-{stickslip.__version__}-{of_this_system()}.whl"
    assert code_in(wheel) == {"keys", *(f"{NAME}/{path.name}" for path in (SHIPPED / NAME).iterdir())}


@pytest.mark.slow
def test_machine_code_is_made_by_the_build_and_serves_where_there_is_no_compiler(tree: Path, tmp_path: Path) -> None:
    """From sources alone, with a key in the cache of nobody; then the wheel runs where numba cannot be imported."""
    rmtree(tree / "src/stickslip/machine_code")
    done = built(tree)
    assert done.returncode == 0, done.stderr
    assert f"making the machine code of the engine ({NAME})" in done.stdout
    assert code_in(wheel_in(tree)) == {"keys", *(f"{NAME}/{path.name}" for path in (SHIPPED / NAME).iterdir())}
    with ZipFile(wheel_in(tree)) as archive:
        archive.extractall(tmp_path / "installed")
    settings = os.environ | {"PYTHONPATH": str(tmp_path / "installed"), "STICKSLIP_CACHE_DIR": str(tmp_path / "cache")}
    code = 'import sys\nsys.modules["numba"] = None\n' + COMMAND.format(arguments=["run", "fig6-slab"])
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=settings)
    assert (ran.stdout.splitlines()[-1], ran.stderr) == ("True 0", "")
    assert list((tmp_path / "cache").rglob("*.o")) == []


@pytest.mark.slow
def test_a_wheel_without_machine_code_is_for_every_system(tree: Path) -> None:
    done = built(tree, STICKSLIP_MACHINE_CODE="later")
    assert done.returncode == 0, done.stderr
    assert wheel_in(tree).name == f"stickslip-{stickslip.__version__}-py3-none-any.whl"
    assert code_in(wheel_in(tree)) == set()


@pytest.mark.slow
def test_an_engine_that_cannot_be_compiled_ends_the_build_in_one_line_with_the_way_out(tree: Path) -> None:
    (tree / "src/stickslip/engine/build.py").write_text("raise SystemExit(1)\n", encoding="utf-8")
    done = built(tree)
    assert done.returncode == 1
    *_, line = done.stderr.splitlines()
    assert line.endswith("the engine could not be compiled; STICKSLIP_MACHINE_CODE=later installs it without machine code")
    assert not (tree / "dist").exists() or not list((tree / "dist").iterdir())
