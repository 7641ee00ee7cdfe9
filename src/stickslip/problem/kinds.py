"""The kinds of bodies and of drivers, by whose names modules answer what other code asks of them (`foundation.by_kind`).

Each stands here with the kind that it is like, whose answers are its own wherever it has no module.
"""

from __future__ import annotations

BODY_KINDS = {"rigid": "", "belt": "rigid", "loop": "rigid", "uniform": "", "layered": ""}
"""Each kind of body (`Body.structure`)."""
DRIVERS_OF_WAVES = {"rigid": "", "lossy": "", "machine": "lossy", "damper": "lossy", "changing": "lossy"}
"""Each kind of driver of a body with waves."""
DRIVER_KINDS = {
    "spring": "",
    "free": "spring",
    "spring_and_dashpot": "spring",
    "position_loop": "spring_and_dashpot",
    **DRIVERS_OF_WAVES,
}
"""Each kind of driver (`Problem.driver_kind`): the far end of a rigid body's spring, nothing, or one of waves."""
