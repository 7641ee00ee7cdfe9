"""Formats of text that programs of laboratories and drill floors write: LabVIEW, LAS, and universal files."""

from __future__ import annotations

from stickslip.extensions.inference.record_forms import las, lvm, uff
from stickslip.foundation.record_files import RecordForm

FORMS = (RecordForm(lvm.begins, lvm.sheet), RecordForm(las.begins, las.sheet), RecordForm(uff.begins, uff.sheet))
"""Each format with what knows it by its first lines."""
