"""Reports: HTML pages that need no other file, with the files beside them. The paper's page is made in `stickslip.paper`."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path


def write_report(study: object, folder: Path, *others: object) -> Path:
    """Write the report of a study by the module that has the name of the study's own one, and return the path of its page."""
    written = import_module(f"{__name__}.{type(study).__module__.rpartition('.')[2]}").write(study, folder, *others)
    return Path(written)
