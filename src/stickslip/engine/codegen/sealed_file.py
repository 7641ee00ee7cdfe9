"""Files of compiled code with a checksum: a damaged one counts as missing."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from stickslip.engine.codegen.cache import CACHE, tell, tidy
from stickslip.foundation.atomic_write import write_atomically

SEAL = b"stickslip cache 1\n"
"""First bytes of each file of the cache; the checksum of its name and content follows, then the content."""
DAMAGED = f"the cache of compiled code in {CACHE} is damaged: what is damaged is compiled again"


def write_sealed(path: Path, content: bytes) -> None:
    """Write content to a file, after the mark SEAL and the checksum."""
    sealed = SEAL + _checksum(path, content) + content
    write_atomically(path, lambda draft: draft.write_bytes(sealed))


def read_sealed(path: Path) -> bytes | None:
    """Return the content of a file, or None if it is missing or its checksum is wrong; remove it in the second case."""
    try:
        sealed = path.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        return None
    start = len(SEAL) + hashlib.sha256().digest_size
    content = sealed[start:]
    if sealed[:start] == SEAL + _checksum(path, content):
        return content
    tell(DAMAGED)
    path.unlink(missing_ok=True)
    return None


def _checksum(path: Path, content: bytes) -> bytes:
    """Return the SHA-256 digest of a file's name and content; with the name, a file copied over another one does not pass."""
    return hashlib.sha256(path.name.encode() + b"\n" + content).digest()


def kept(text: str, make: Callable[[], bytes]) -> bytes:
    """Return the machine code of a text: from the cache, or made and written there. Whatever a file lacks is made again."""
    if CACHE is None:
        return make()
    path = CACHE / "formulas" / f"{hashlib.sha256(text.encode()).hexdigest()}.nbo"
    with suppress(OSError):
        if (found := read_sealed(path)) is not None:
            os.utime(path)  # it has been used
            return found
    made = make()
    with suppress(OSError):  # the next process makes it again
        path.parent.mkdir(exist_ok=True)
        write_sealed(path, made)
        tidy()
    return made
