"""Keys of a local cluster. The processes of dask run any code that is sent to them, so only their owner may send it.

The loopback address of a machine can be reached by all its users. The scheduler, the workers and the client of a sweep therefore
share a key that is made for this sweep and kept in memory. A connection without the key is refused.
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
"""Host name in the certificate, the same as in the keys that dask makes."""
LASTS = 365
"""Number of days for which a key is valid: longer than any sweep takes."""
PATIENCE = 60.0
"""Longest time (s) that making a key may take."""


def own_security() -> Security | None:
    """Return a new key for a cluster, made by the package `cryptography` or by the command `openssl`.

    If neither exists, return None and write one line of warning: other users of the machine could then run code in the cluster.
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
    """Return a key and its certificate as texts, or None if there is no such command or it fails."""
    with tempfile.TemporaryDirectory() as folder:  # only this user can enter the folder
        key, certificate = Path(folder, "key.pem"), Path(folder, "certificate.pem")
        command = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", str(LASTS), "-subj", f"/CN={NAME}"]
        command += ["-addext", f"subjectAltName=DNS:{NAME}", "-keyout", str(key), "-out", str(certificate)]
        try:
            subprocess.run(command, check=True, capture_output=True, stdin=subprocess.DEVNULL, timeout=PATIENCE)
            return key.read_text(), certificate.read_text()
        except (OSError, subprocess.SubprocessError):
            return None
