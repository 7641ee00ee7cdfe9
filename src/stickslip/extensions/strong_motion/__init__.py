"""Earthquake records: files of strong motion as they come, and the sliding of slopes and isolated blocks under them."""

from __future__ import annotations

from stickslip.extension import Extension


class StrongMotionExtension(Extension):
    """Readers of strong-motion files, and the study of sliding under many records."""

    name = "strong_motion"


EXTENSION = StrongMotionExtension()
