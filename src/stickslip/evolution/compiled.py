"""Compilation and its cache: the engine is compiled once, each friction formula once, both kept on disk.

The cache folder's name carries a hash of every source that is compiled: an edited kernel can never meet its old machine code
(numba itself looks at the file of a function, not at the functions it calls). Formulas are called through their addresses, so
that a new law compiles its own few functions and nothing of the engine.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import llvmlite.ir as ir
import numba
import platformdirs
from numba import carray, njit, types
from numba.extending import intrinsic

from stickslip.evolution.generate import ORDER, FormulaWriter
from stickslip.friction.expression import Expression

F = TypeVar("F", bound=Callable[..., Any])


def _sources_hash() -> str:
    package = Path(__file__).parents[1]
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for path in sorted([*(package / "evolution").glob("*.py"), package / "friction" / "expression.py"]):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def cache_folder() -> Path:
    """Where compiled code is kept: STICKSLIP_CACHE_DIR, else the user's cache folder, else a temporary one."""
    chosen = os.environ.get("STICKSLIP_CACHE_DIR")
    root = Path(chosen) if chosen else platformdirs.user_cache_path("stickslip")
    try:
        folder = root / f"compiled-{_sources_hash()}"
        (folder / "formulas").mkdir(parents=True, exist_ok=True)
    except OSError:
        folder = Path(tempfile.gettempdir()) / f"stickslip-compiled-{_sources_hash()}"
        (folder / "formulas").mkdir(parents=True, exist_ok=True)
    return folder


CACHE = cache_folder()


@contextmanager
def _cached_on_disk() -> Iterator[None]:
    """numba asks for its cache folder when a function is decorated: lend it ours for that moment only."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


def kernel(function: F) -> F:
    """Compile a function of the engine, with the cache of this module."""
    return _compiled(function)


def inlined(function: F) -> F:
    """As `kernel`, put in place where it is called: a call would copy every field of every array of the engine's state."""
    return _compiled(function, forceinline=True)


def _compiled(function: F, **options: bool) -> F:
    with _cached_on_disk():
        compiled: F = njit(cache=True, error_model="numpy", nogil=True, fastmath={"contract"}, **options)(function)
    return compiled


@dataclass(frozen=True)
class CompiledFormula:
    """Addresses of a formula's C functions (see `generate`) and the number of constants it wants."""

    prepare: Callable[..., None]
    value: int
    rate_jet: int
    motion_jet: int
    size: int
    keep_alive: Any


@cache
def compile_formula(formula: Expression, parameters: tuple[str, ...]) -> CompiledFormula:
    """Write, compile and load the functions of a formula; what was compiled before comes from the disk."""
    writer = FormulaWriter(formula, parameters, ORDER)
    text = writer.module()
    name = f"formula_{hashlib.sha256(text.encode()).hexdigest()[:20]}"
    path = CACHE / "formulas" / f"{name}.py"
    if not path.exists():
        with tempfile.NamedTemporaryFile("w", dir=path.parent, suffix=".tmp", delete=False) as draft:
            draft.write(text)
        Path(draft.name).replace(path)
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # numba looks a cached function's module up by its name
    with _cached_on_disk():
        spec.loader.exec_module(module)
    functions = {part: getattr(module, part) for part in ("value", "rate_jet", "motion_jet")}
    addresses = {part: int(function.address) for part, function in functions.items()}
    return CompiledFormula(prepare=module.prepare.ctypes, size=writer.size, keep_alive=module, **addresses)


@intrinsic
def call_value(typingctx: Any, address: Any, c: Any, dx: Any, s: Any, out: Any) -> Any:
    """value(c, dx, s, out) of the formula at `address`; c and out are addresses of arrays."""
    return types.void(types.int64, types.int64, types.float64, types.float64, types.int64), _caller("pffp")


@intrinsic
def call_jet(typingctx: Any, address: Any, c: Any, k: Any, load: Any, s: Any) -> Any:
    """rate_jet or motion_jet(c, k, L, s) of the formula at `address`; all are addresses of arrays."""
    return types.void(types.int64, types.int64, types.int64, types.int64, types.int64), _caller("pppp")


@intrinsic
def float_pointer(typingctx: Any, address: Any) -> Any:
    """An address as a pointer to floats."""
    return types.CPointer(types.float64)(types.intp), _cast(ir.DoubleType())


@intrinsic
def integer_pointer(typingctx: Any, address: Any) -> Any:
    """An address as a pointer to 64-bit integers."""
    return types.CPointer(types.int64)(types.intp), _cast(ir.IntType(64))


def _cast(kind: ir.Type) -> Callable[..., Any]:
    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.inttoptr(args[0], kind.as_pointer())

    return codegen


@kernel
def floats(array: Any) -> Any:
    """The same array without its reference count: counting it up and down in every small function costs more than the work."""
    return carray(float_pointer(array.ctypes.data), array.shape)


@kernel
def integers(array: Any) -> Any:
    """As `floats`, for integers."""
    return carray(integer_pointer(array.ctypes.data), array.shape)


def _caller(kinds: str) -> Callable[..., Any]:
    """Code that calls a C function through its address; `p` stands for an array's address, `f` for a float."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pointer = ir.IntType(8).as_pointer()
        c_types = [ir.DoubleType() if kind == "f" else pointer for kind in kinds]
        function = builder.inttoptr(args[0], ir.FunctionType(ir.VoidType(), c_types).as_pointer())
        passed = [a if kind == "f" else builder.inttoptr(a, pointer) for a, kind in zip(args[1:], kinds, strict=True)]
        builder.call(function, passed)
        return context.get_dummy_value()

    return codegen
