"""The engine's algorithm in C (c_kernel/taylor.c), with the law's recurrences from the same formula: `cc -O3 -march=native`."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

import numpy as np

from benchmarks import ours
from benchmarks.problems import Case
from benchmarks.runner import Runner, UnavailableError
from stickslip.engine.contact_step import certificate
from stickslip.engine.formula_code.taylor_series import SIGNATURES, FormulaWriter
from stickslip.engine.state import layout, workspace
from stickslip.foundation.kernels.memory.records import FLOATS, MemoryRecord
from stickslip.friction.formula.expression import Expression
from stickslip.problem import run_codes

SOURCE = Path(__file__).parent / "c_kernel" / "taylor.c"
FLAGS = ("-O3", "-march=native", "-shared", "-fPIC", "-fno-math-errno", "-fopenmp", "-Wl,-Bsymbolic")


SINES = ("#define sine(e) (2.0 * sin(0.5 * (e)) * cos(0.5 * (e)))", "#define versine(e) (2.0 * sin(0.5 * (e)) * sin(0.5 * (e)))")
"""What `engine.series.sine` does, by the C library: the compiler makes one call of all."""

NAMES = (
    "#define fused(a, b, c) fma(a, b, c)",
    "#define abs(x) fabs(x)",
    "#define max(x, y) fmax(x, y)",
    "#define min(x, y) fmin(x, y)",
    '#include "balls.h"',
)
"""What the statements call otherwise than C, and the radii of elementary functions (c_kernel/balls.h)."""


def c_function(writer: FormulaWriter, part: str) -> str:
    """The straight-line statements of a formula's function as C: what is missing is declarations and semicolons."""
    arguments = ", ".join(f"double *restrict {name[:-2]}" if name.endswith("[]") else f"double {name}" for name in SIGNATURES[part])
    declared: set[str] = set()
    lines = []
    for statement in writer.statements(part):
        target, _, _ = statement.partition(" ")
        new = "[" not in target and target not in declared
        declared.add(target)
        lines.append(f"    {'double ' if new else ''}{statement};")
    return f"static void {part}(const {arguments}) {{\n" + "\n".join(lines) + "\n}\n"


def structure(record: type[MemoryRecord], name: str = "") -> str:
    """A record of the engine as a structure of C, place for place."""
    lines = []
    for field, place in record.places.items():
        kind = "double" if place.kind in (float, FLOATS) else "int64_t"
        if isinstance(place.kind, type) and issubclass(place.kind, MemoryRecord):
            lines.append(f"    {place.kind.__name__} {'' if place.inside else '*'}{field};")
            if place.size > place.kind.total:
                lines.append(f"    double after_{field}[{place.size - place.kind.total}];")
        elif place.kind in (float, int):
            lines.append(f"    {kind} {field};")
        else:
            lines.append(f"    {kind} {field}[{place.size}];" if place.inside else f"    {kind} *{field};")
    return "typedef struct {\n" + "\n".join(lines) + f"\n}} {name or record.__name__};"


def header(writer: FormulaWriter) -> str:
    """law.h: the engine's records as structures, its codes as numbers, and the law."""
    names = {name: value for module in (layout, workspace) for name, value in vars(module).items() if isinstance(value, int)}
    names |= {
        code.name: int(code) for codes in (run_codes.Stop, layout.Cause, layout.Incoming) for code in codes if code.name != "NONE"
    }
    defines = [f"#define {name} {value}" for name, value in names.items() if name.isupper()]
    for name in ("RATIOS", "SHRUNK", "SHRUNK_SLOPE"):
        numbers = ", ".join(repr(float(number)) for number in getattr(certificate, name))
        defines.append(f"static const double {name}[] = {{{numbers}}};")
    defines.append(f"#define DISCS {len(certificate.RATIOS)}")
    records = [
        structure(one) for one in vars(layout).values() if isinstance(one, type) and issubclass(one, MemoryRecord) and one.places
    ]
    return (
        "\n".join([*defines, *records, structure(workspace.Run, "Memory"), *SINES, *NAMES])
        + "\n\n"
        + "\n".join(c_function(writer, part) for part in ("value", "rate_jet", "motion_jet", "radii"))
    )


@cache
def library(formula: Expression, parameters: tuple[str, ...]) -> ctypes.CDLL:
    """Compile the C kernel for a law."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        raise UnavailableError("no C compiler")
    folder = Path(tempfile.mkdtemp(prefix="stickslip-c-"))
    (folder / "law.h").write_text(header(FormulaWriter(formula, parameters)))
    target = folder / "taylor.so"
    subprocess.run([compiler, *FLAGS, f"-I{folder}", f"-I{SOURCE.parent}", str(SOURCE), "-o", str(target), "-lm"], check=True)
    loaded = ctypes.CDLL(str(target))
    loaded.prepare_tables()
    loaded.advance.argtypes = (ctypes.c_void_p, ctypes.c_int64, ctypes.c_double, ctypes.c_int64)
    loaded.advance.restype = ctypes.c_int64
    loaded.run_members.argtypes = (
        *[ctypes.c_void_p] * 4,
        ctypes.c_int64,
        *[ctypes.c_void_p] * 5,
        ctypes.c_int64,
        ctypes.c_int,
        ctypes.c_void_p,
    )
    loaded.run_members.restype = ctypes.c_int64
    return loaded


def runner(case: Case, tolerance: float) -> Runner:
    """The C kernel on the engine's own table and history."""
    law = case.problem.friction
    (formula,) = law.trees()
    function = library(formula, law.parameters()).advance
    addresses: dict[int, int] = {}

    def kernel(table: np.ndarray, last_trip: int, last_phase: float, budget: int) -> int:
        address = addresses.get(id(table)) or addresses.setdefault(id(table), table.ctypes.data)
        return int(function(address, last_trip, last_phase, budget))

    return ours.runner(case, tolerance, kernel)
