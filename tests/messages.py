"""What tests of messages share."""

from __future__ import annotations

import re


def places_twice(text: str) -> set[str]:
    """Return the places before the colons of a message that it names twice, as "Problem" in "Problem: friction: Problem: ..."."""
    places = re.findall(r"(?:^|: )([A-Za-z_][\w.-]{2,40})(?=: )", text)
    return {one for one in places if places.count(one) > 1}
