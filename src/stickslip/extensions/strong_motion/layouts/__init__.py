"""Layouts of strong-motion files: each is a file that knows its layout by the first lines, and reads it as a sheet.

To add one, write a module with `begins` and `sheet`, and name it in `FORMS`, with a synthetic sample in tests.
"""

from __future__ import annotations

from stickslip.extensions.strong_motion.layouts import at2, cosmos, csmip, cwb, dyna, geonet, knet, obspy_text, plain, slammer, smc
from stickslip.foundation.record_files import RecordForm

LAYOUTS = (at2, knet, cosmos, geonet, csmip, smc, dyna, cwb, obspy_text, slammer, plain)
"""The layouts; text that states no more than an interval is known last."""
FORMS = tuple(RecordForm(layout.begins, layout.sheet) for layout in LAYOUTS)
"""Each layout with what knows it by its first lines."""
