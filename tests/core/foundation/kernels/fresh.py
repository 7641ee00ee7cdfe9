"""Scripts in processes of their own, with a cache of their own, and with other machine code than came with the package."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

SHIPPED_ELSEWHERE = """
from pathlib import Path
from stickslip.foundation import code_key
code_key.SHIPPED = Path({folder!r})
"""
"""First lines of a script for which machine code that came with the package lies in another folder."""

COMMAND = """
import sys
from stickslip.cli.main import main
try:
    main({arguments!r})
except SystemExit as ended:
    code = ended.code
print("numba" in sys.modules, code)
"""
"""Runs a command; the last line says whether numba was loaded, and the exit code."""


def python(code: str, cache: Path | str, shipped: Path | None = None, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a script in a new process and return what it says; `shipped` is the folder where it finds machine code that came."""
    first = SHIPPED_ELSEWHERE.format(folder=str(shipped)) if shipped else ""
    settings = os.environ | {"STICKSLIP_CACHE_DIR": str(cache), "OPENBLAS_NUM_THREADS": "1"} | environment
    return subprocess.run([sys.executable, "-c", first + code], capture_output=True, text=True, check=False, env=settings)


def printed(done: subprocess.CompletedProcess[str]) -> str:
    """Return what a script printed, which must have ended well."""
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout
