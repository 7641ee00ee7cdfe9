# What others take from run.check. Each name is imported when it is first used; all else is the room's own.

from stickslip.run.check.asked import (
    Fact,  # A number with its unit, or a word, with its name and its meaning.
)
from stickslip.run.check.examine import (
    # The findings of `examine`: given numbers (by table of the scenario), derived numbers, sentences for users, and warnings.
    Examination,
    warnings_of,  # Return what a user should know before trusting a run of a scenario whose uniqueness is `contact`, one line each.
)
from stickslip.run.check.stability import (
    other_start,  # Return a sentence if a slab or a string would start otherwise with a mass at the contact than without, else "".
)
from stickslip.run.check.with_waves import (
    LARGE_STRAIN,  # A larger shear strain (no unit) than this raises a warning: linear elasticity is doubtful.
)

__all__ = [
    "LARGE_STRAIN",
    "Examination",
    "Fact",
    "other_start",
    "warnings_of",
]
