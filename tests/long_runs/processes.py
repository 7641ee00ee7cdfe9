"""Runs in a process of their own, to be interrupted or killed."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path


def killed(code: str, folder: Path, file: str, with_signal: signal.Signals, times: int = 1) -> subprocess.CompletedProcess[str]:
    """Run code in a process of its own, and send a signal once its checkpoint has been renewed so often."""
    process = subprocess.Popen([sys.executable, "-c", code], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    seen: set[int] = set()
    for _ in range(6000):
        if (folder / file).exists():
            seen.add((folder / file).stat().st_mtime_ns)
        if len(seen) > times or process.poll() is not None:
            break
        time.sleep(0.01)
    assert process.poll() is None, process.communicate()[1]
    process.send_signal(with_signal)
    out, err = process.communicate(timeout=60)
    return subprocess.CompletedProcess([], process.returncode, out, err)
