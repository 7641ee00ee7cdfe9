"""Earthquake records: files of strong motion as they come, and the sliding of slopes and isolated blocks under them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from stickslip.extension import Extension

if TYPE_CHECKING:
    from stickslip.foundation.record_files import RecordForm


class StrongMotionExtension(Extension):
    """Readers of strong-motion files, and the study of sliding under many records."""

    name = "strong_motion"

    def forms(self) -> Sequence[RecordForm]:
        """Return the layouts of strong-motion files."""
        from stickslip.extensions.strong_motion.layouts import FORMS

        return FORMS


EXTENSION = StrongMotionExtension()
