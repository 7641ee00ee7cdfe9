"""Earthquake records: files of strong motion as they come, and the sliding of slopes and isolated blocks under them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from stickslip.extension import Command, Extension

if TYPE_CHECKING:
    from stickslip.foundation.record_files import RecordForm


class StrongMotionExtension(Extension):
    """Readers of strong-motion files, and the study of sliding under many records."""

    name = "strong_motion"

    def forms(self) -> Sequence[RecordForm]:
        """Return the layouts of strong-motion files."""
        from stickslip.extensions.strong_motion.layouts import FORMS

        return FORMS

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command `slide`."""
        from stickslip.extensions.strong_motion.commands.slide import slide

        return {"Questions that need many runs": (slide,)}

    def public(self) -> Mapping[str, str]:
        """Return the study and the class of its result."""
        home = "stickslip.extensions.strong_motion"
        return {
            "loading.record": f"{home}.record:record",
            "studies.SlidingDisplacements": f"{home}.displacements:SlidingDisplacements",
            "studies.sliding": f"{home}.sliding:sliding",
        }


EXTENSION = StrongMotionExtension()
