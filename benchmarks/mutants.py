"""Wrong versions of the source: mistakes by name that somebody might make, and others drawn at random from the syntax tree."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

SOURCE = Path("src/stickslip")
CORE = ("contact", "engine", "engine/creep", "engine/history", "engine/input", "run", "solution", "solution/observables")
AROUND = (
    *("cli", "problem/scenarios", "solution/files", "extensions/explorer/model", "extensions/inference"),
    *("extensions/planar", "extensions/schemes", "extensions/sweeps"),
)
PACKAGES = CORE + AROUND
"""Folders of the package from which mutants are drawn: the core, which decides what a run gives, and the rooms around it."""


@dataclass(frozen=True)
class Mutant:
    """One change of one file."""

    name: str
    path: str
    """Relative to the package's folder."""
    begin: int
    end: int
    new: str

    def applied(self, text: bytes) -> bytes:
        """The file's text with the change."""
        return text[: self.begin] + self.new.encode() + text[self.end :]

    @property
    def package(self) -> str:
        """The folder of PACKAGES that the file lies in, the innermost one."""
        return package_of(self.path)


def package_of(path: str) -> str:
    """The innermost folder of PACKAGES that a file lies in; outside of all, the first one of its path."""
    return max((one for one in PACKAGES if path.startswith(one + "/")), key=len, default=path.split("/")[0])


@dataclass(frozen=True)
class Named:
    """A mistake in words: a text that occurs once in a file, and what it becomes."""

    name: str
    path: str
    old: str
    new: str


NAMED = (
    Named("echo-sign", "engine/waves/incoming_load.py", "share * (2.0 *", "-share * (2.0 *"),
    Named(
        "factor-two-in-the-echo",
        "engine/waves/incoming_load.py",
        "* (2.0 * params.impedance * rate[k]",
        "* (1.0 * params.impedance * rate[k]",
    ),
    Named(
        "factor-two-in-the-tree",
        "engine/waves/echo_queue.py",
        "- 2.0 * run.params.impedance * rate[k]",
        "- run.params.impedance * rate[k]",
    ),
    Named("a-trip-too-early", "engine/waves/incoming_load.py", "run.history[n].trip - 1", "run.history[n].trip"),
    Named(
        "wrong-side-of-a-fold",
        "engine/folds/fold.py",
        "if abs(level - branch.keep_to) < abs(",
        "if abs(level - branch.keep_to) > abs(",
    ),
    Named(
        "fold-outrun-backwards",
        "engine/folds/fold.py",
        "return direction * run.trial[1] > grows * (",
        "return direction * run.trial[1] < grows * (",
    ),
    Named("tolerance-times-1000", "engine/input/prepare.py", "= rtol * SHARE_OF_TOLERANCE,", "= 1000.0 * rtol * SAFETY,"),
    Named(
        "no-certificates",
        "engine/contact_step/certificate.py",
        "    while not share <= allowed(run) and attempt < ATTEMPTS:",
        "    while not share <= 1e300 and attempt < ATTEMPTS:",
    ),
    Named(
        "no-proof-of-implicit-steps",
        "engine/radau/step.py",
        "    return error if error > 1.0 else proven_error(run, error)",
        "    return error",
    ),
    Named(
        "left-and-right-exchanged",
        "engine/history/history.py",
        'side="left" if side == "left" else "right") - 1',
        'side="right" if side == "left" else "left") - 1',
    ),
    Named(
        "heat-without-slip-rate",
        "solution/observables/energy/balance.py",
        "return lambda at: history.resistance(at) * np.abs(history.rate(at))",
        "return lambda at: history.resistance(at) * history.rate(at)",
    ),
    Named(
        "heat-at-zero-rate",
        "engine/history/history.py",
        "place = (slip, np.abs(self.rate(at)), one_argument(states))",
        "place = (slip, 0.0 * np.abs(self.rate(at)), one_argument(states))",
    ),
    Named(
        "no-kinetic-energy-of-the-block",
        "solution/observables/kinds/rigid.py",
        '"stored": spring + 0.5 * body.inertia * rate**2',
        '"stored": spring + 0.0 * body.inertia * rate**2',
    ),
    Named("year-of-365-days", "foundation/constants.py", "YEAR = 31_557_600.0", "YEAR = 31_536_000.0"),
)
"""Mistakes by name."""


def named(root: Path) -> list[Mutant]:
    """The mistakes by name that still have their place; a place that has gone is an error."""
    found = []
    for one in NAMED:
        text = (root / SOURCE / one.path).read_bytes()
        if text.count(one.old.encode()) != 1:
            raise SystemExit(f"mutants: the text of '{one.name}' is not once in {one.path}: bring it up to date")
        begin = text.index(one.old.encode())
        found.append(Mutant(one.name, one.path, begin, begin + len(one.old.encode()), one.new))
    return found


def drawn(root: Path, count: int, seed: int, packages: tuple[str, ...] = PACKAGES) -> list[Mutant]:
    """Random mutants of the packages' files, each package as often as any other."""
    rng = np.random.default_rng(seed)
    choices = {package: list(of_package(root, package)) for package in packages}
    orders = {package: iter(rng.permutation(len(found)).tolist()) for package, found in choices.items()}
    result = []
    for n in range(count):
        package = packages[n % len(packages)]
        place = next(orders[package], None)
        if place is not None:
            result.append(choices[package][place])
    return result


def of_package(root: Path, package: str) -> Iterator[Mutant]:
    """Every mutant of a package's files, but for those of other packages within it."""
    for path in sorted((root / SOURCE / package).rglob("*.py")):
        name = str(path.relative_to(root / SOURCE))
        if package_of(name) == package:
            yield from _of_file(path, name)


def _of_file(path: Path, name: str) -> Iterator[Mutant]:
    """Every mutant of a file: one for each operator, comparison and number in code that runs."""
    text = path.read_bytes()
    lines = [0, *(i + 1 for i, byte in enumerate(text) if byte == 10)]
    tree = ast.parse(text)
    ignored = {id(inner) for node in ast.walk(tree) for part in _declarations(node) for inner in ast.walk(part)}
    for node in ast.walk(tree):
        if id(node) in ignored:
            continue
        for first, last, new in _changes(node):
            begin = lines[first[0] - 1] + first[1]
            end = lines[last[0] - 1] + last[1]
            old = text[begin:end].decode()
            changed = new(old)
            if changed is not None and changed != old:
                yield Mutant(
                    f"{name}:{first[0]}:{first[1]} {old.strip()[:30]} -> {changed.strip()[:30]}", name, begin, end, changed
                )


def _declarations(node: ast.AST) -> list[ast.AST]:
    """Annotations and decorators: no code that runs."""
    found: list[ast.AST | None] = []
    if isinstance(node, ast.FunctionDef):
        found = [
            node.returns,
            *node.decorator_list,
            *(argument.annotation for argument in ast.walk(node.args) if isinstance(argument, ast.arg)),
        ]
    elif isinstance(node, ast.AnnAssign):
        found = [node.annotation]
    elif isinstance(node, ast.ClassDef):
        found = list(node.decorator_list)
    return [one for one in found if one is not None]


_SWAPS: dict[type, tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Lt: ("<", "<="),
    ast.LtE: ("<=", "<"),
    ast.Gt: (">", ">="),
    ast.GtE: (">=", ">"),
    ast.Eq: ("==", "!="),
    ast.And: ("and", "or"),
    ast.Or: ("or", "and"),
}


def _changes(node: ast.AST) -> Iterator[tuple[tuple[int, int], tuple[int, int], object]]:  # type: ignore[type-arg]
    """Places (line, column) from and to, and a function from the old text there to the new one."""
    if isinstance(node, ast.BinOp) and type(node.op) in _SWAPS:
        yield (*_between(node.left, node.right), _swap(node.op))
    elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _SWAPS:
        yield (*_between(node.left, node.comparators[0]), _swap(node.ops[0]))
    elif isinstance(node, ast.BoolOp):
        yield (*_between(node.values[0], node.values[1]), _swap(node.op))
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        yield (node.lineno, node.col_offset), (node.operand.lineno, node.operand.col_offset), lambda old: old.replace("-", "", 1)
    elif isinstance(node, ast.Constant) and type(node.value) in (int, float):
        yield _start(node), _stop(node), _other_number
    elif isinstance(node, ast.Name) and node.id in ("min", "max"):
        yield _start(node), _stop(node), lambda old: {"min": "max", "max": "min"}[old]


def _start(node: ast.expr) -> tuple[int, int]:
    return node.lineno, node.col_offset


def _stop(node: ast.expr) -> tuple[int, int]:
    assert node.end_lineno is not None
    assert node.end_col_offset is not None
    return node.end_lineno, node.end_col_offset


def _between(left: ast.expr, right: ast.expr) -> tuple[tuple[int, int], tuple[int, int]]:
    return _stop(left), _start(right)


def _swap(operator: ast.AST) -> object:
    old, new = _SWAPS[type(operator)]

    def swapped(text: str) -> str | None:
        return text.replace(old, new, 1) if text.count(old) == 1 else None

    return swapped


def _other_number(text: str) -> str | None:
    """Whole numbers grow by 1, others by half; 0.0 becomes 1.0."""
    try:
        value = ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return None
    if isinstance(value, int):
        return str(value + 1)
    return "1.0" if value == 0.0 else repr(1.5 * value)
