"""Keys of a cluster that is started here: dask's processes run whatever code they are sent, so only their owner may send any.

Every user of this machine reaches its loopback address. Scheduler, workers and client of one sweep therefore share a key that is
made for it and kept in memory: a connection without it is refused.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from distributed import Security

NAME = "dask-internal"
LASTS = 365
"""Days for which a key is valid: more than a sweep takes."""
PATIENCE = 60.0
"""Time (s) that making a key may take."""


def own_security() -> Security | None:
    """Return a new key for a cluster, made by the package `cryptography` or by the command `openssl`.

    Where there is neither, return None and say so in one line: other users of this machine could then run code in the cluster.
    """
    from distributed import Security

    try:
        return Security.temporary()
    except ImportError:
        made = _made_by_openssl()
    if made is None:
        sys.stderr.write(
            "stickslip: sweep: without a key, other users of this machine can run code in the cluster: pip install cryptography\n"
        )
        return None
    key, certificate = made
    roles = ("client", "scheduler", "worker")
    keys, certificates = {f"tls_{role}_key": key for role in roles}, {f"tls_{role}_cert": certificate for role in roles}
    return Security(require_encryption=True, tls_ca_file=certificate, **keys, **certificates)


def _made_by_openssl() -> tuple[str, str] | None:
    """Return a key and its certificate as texts, None where there is no such command or it fails."""
    with tempfile.TemporaryDirectory() as folder:  # which only this user can enter
        key, certificate = Path(folder, "key.pem"), Path(folder, "certificate.pem")
        command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", str(LASTS), "-subj", f"/CN={NAME}"]
        command += ["-addext", f"subjectAltName=DNS:{NAME}", "-keyout", str(key), "-out", str(certificate)]
        try:
            subprocess.run(command, check=True, capture_output=True, stdin=subprocess.DEVNULL, timeout=PATIENCE)
            return key.read_text(), certificate.read_text()
        except (OSError, subprocess.SubprocessError):
            return None
