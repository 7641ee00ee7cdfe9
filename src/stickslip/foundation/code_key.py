"""The key of code: a hash of what is executed, which comments, docstrings, assertions and the layout of lines leave as it is.

It is made from Python's bytecode. The compiler chooses a few instructions by where lines end, so that everything is put on one line
first. That takes a second for three hundred files; the key is therefore kept in the cache, under a hash of the files themselves.
"""

from __future__ import annotations

import ast
import hashlib
import os
from collections.abc import Iterable
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import CodeType

from stickslip.foundation.private_folder import private_folder
from stickslip.foundation.sealed_files import cache_root, read_sealed, write_sealed

PACKAGE = Path(__file__).parents[1]
DIGITS_OF_KEY = 16
"""Number of hexadecimal digits of a key."""
SHIPPED = PACKAGE / "machine_code"
"""Where machine code, and the keys of code, lie that are made when the package is built."""
ONE_PLACE = {"lineno": 1, "end_lineno": 1, "col_offset": 0, "end_col_offset": 0}
"""Where all code is put."""


def key_of_folders(names: Iterable[str], beside: str = "", package: Path = PACKAGE) -> str:
    """Return the key of the code in folders and files of the package, together with another key."""
    found: list[str] = []
    for path in (str(package / name) for name in names):
        inside = [f"{top}/{file}" for top, _, files in os.walk(path) for file in files if file.endswith(".py")]
        found += inside or [path]  # a file
    return key_of_files(sorted(set(found)), beside)


def key_of_files(files: Iterable[Path | str], beside: str = "") -> str:
    """Return the key of the code in files; it came with the package, is kept if the cache has a private folder for it, or is made.

    The folder must be private, because a wrong key would lead to other machine code.
    """
    texts = []
    for file in files:
        with open(file, "rb", buffering=0) as opened:  # noqa: PTH123  # of hundreds of files, in less time than by Path
            texts.append(opened.read())
    digest = hashlib.sha256(beside.encode())
    for text in (Path(__file__).read_bytes(), *texts):  # how a key is made decides it, too
        digest.update(b"%d " % len(text) + text)
    name = digest.hexdigest()
    if name in keys_that_came():
        return keys_that_came()[name]
    kept = None
    with suppress(OSError):
        kept = private_folder(cache_root() / "keys") / name
        if (found := read_sealed(kept)) is not None:
            return found.decode()
    key = key_of(texts, beside)
    if kept is not None:
        with suppress(OSError):  # whatever else is kept in the cache will meet the same fault, and say so
            write_sealed(kept, key.encode())
    return key


@cache
def keys_that_came() -> dict[str, str]:
    """Return the keys that came with the package, by the hash of the files that they were made of."""
    path = SHIPPED / "keys"
    lines = (read_sealed(path, own=False) or b"").decode().split() if path.exists() else []
    return dict(zip(lines[::2], lines[1::2], strict=True))


def key_of(texts: Iterable[bytes], beside: str) -> str:
    """Return the key of the code in some source files."""
    digest = hashlib.sha256(beside.encode())
    for text in texts:
        digest.update(_executed(text))
    return digest.hexdigest()[:DIGITS_OF_KEY]


@cache  # most files belong to two keys: that of machine code, and that of a checkpoint
def _executed(text: bytes) -> bytes:
    """Return the hash of the code in a source file, compiled as if all of it stood in one place."""
    tree = ast.parse(text)
    todo: list[ast.AST] = [tree]
    while todo:
        inside = vars(todo.pop())
        if "lineno" in inside:
            inside |= ONE_PLACE
        for one in inside.values():
            todo += [each for each in (one if isinstance(one, list) else [one]) if isinstance(each, ast.AST)]
    code = compile(tree, "", "exec", dont_inherit=True, optimize=2)
    return hashlib.sha256(_bytecode(code).encode()).digest()


def _bytecode(code: CodeType) -> str:
    """Return all that a code object does, with the functions in it, as a text: without numbers of lines."""
    parts = [code.co_name, code.co_argcount, code.co_kwonlyargcount, code.co_posonlyargcount, code.co_flags, code.co_code]
    parts += [code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_exceptiontable]
    for one in code.co_consts:
        parts.append(_bytecode(one) if isinstance(one, CodeType) else sorted(map(repr, one)) if isinstance(one, frozenset) else one)
    return repr(parts)
