"""Identify the code that is compiled, so that edited code never meets its old machine code.

The key is a hash of the syntax trees of all compiled sources without their docstrings: an edited comment, docstring or line break
leaves it as it is. To make the trees takes a quarter of a second, so the key is kept on disk under a hash of the files themselves.
"""

from __future__ import annotations

import ast
import hashlib
import re
import sys
from collections.abc import Iterable
from pathlib import Path

import numba

from stickslip.foundation.atomic_write import write_atomically

NOT_COMPILED = ("cache.py", "private_folder.py", "sealed_cache.py", "sources.py")
"""Files in the compiled folders that decide where machine code is kept, but not what it does; the hash leaves them out."""
COMPILED_FOLDERS = ("engine", "batch/kernels", "friction/formula/operations")
"""Folders of the package whose files all enter the hash, because they hold compiled functions or write them."""
COMPILED_FILES = (
    "engine_input/branch_table.py",
    "foundation/constants.py",
    "friction/formula/expression.py",
    "trajectory/history.py",
    "trajectory/phase_index.py",
    "trajectory/slip_events.py",
    "trajectory/status.py",
    "trajectory/turning_points.py",
)
"""Other files that hold compiled functions, or constants that compiled functions use; tests/test_layers.py checks the list."""
VERSIONS = f"{numba.__version__} {sys.version}"
"""The versions of numba and Python, on which machine code depends, too."""
DIGITS = 16
"""Number of hexadecimal digits of a key."""


def compiled_sources() -> list[Path]:
    """Return the paths of all files whose content is compiled, sorted."""
    package = Path(__file__).parents[2]
    folders = [path for folder in COMPILED_FOLDERS for path in (package / folder).rglob("*.py")]
    inside = [path for path in folders if path.name not in NOT_COMPILED]
    return sorted([*inside, *(package / name for name in COMPILED_FILES)])


def key_of(texts: Iterable[bytes]) -> str:
    """Return the hash of the code in some source files: comments, docstrings and the layout of lines do not enter it."""
    digest = hashlib.sha256(VERSIONS.encode())
    for text in texts:
        digest.update(ast.dump(_without_docstrings(ast.parse(text))).encode())
    return digest.hexdigest()[:DIGITS]


def _without_docstrings(tree: ast.Module) -> ast.Module:
    """Remove every statement that is only a text from a syntax tree, and return the tree."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            node.body = [statement for statement in node.body if not _is_text(statement)]
    return tree


def _is_text(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant) and isinstance(statement.value.value, str)


def remembered_key(folder: Path | None) -> str:
    """Return the key of all compiled sources.

    It is kept in `folder`, in a file that is named for the hash of the unchanged files. The folder must be private: a wrong key
    would lead to other machine code. Without a folder, or where it cannot be written, the key is made anew.
    """
    texts = [path.read_bytes() for path in compiled_sources()]
    if folder is None:
        return key_of(texts)
    digest = hashlib.sha256(VERSIONS.encode())
    for text in texts:
        digest.update(text)
    kept = folder / digest.hexdigest()
    try:
        found = kept.read_text(encoding="ascii")
    except (OSError, UnicodeError):
        found = ""
    if re.fullmatch(rf"[0-9a-f]{{{DIGITS}}}", found):
        return found
    key = key_of(texts)
    try:
        write_atomically(kept, lambda draft: draft.write_text(key, encoding="ascii"))
    except OSError:
        return key  # the folder of machine code will meet the same fault, and says so
    return key
