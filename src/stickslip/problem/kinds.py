"""The kinds of bodies and of drivers. All code that depends on a kind is in modules with its name (`foundation.by_kind`)."""

from __future__ import annotations

BODY_KINDS = {"rigid": "", "uniform": "", "layered": ""}
"""Each kind of body (`Body.structure`), with the one that it is like where it has no answers of its own."""
DRIVER_KINDS = {"spring": "", "rigid": "", "lossy": "", "spring_and_dashpot": "spring", "machine": "lossy", "changing": "lossy"}
"""Each kind of driver (`Problem.driver_kind`), with the one that it is like where it has no answers of its own."""
