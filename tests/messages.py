"""What tests of messages share."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from stickslip.foundation.errors import InputError


def places_twice(text: str) -> set[str]:
    """Return the places before the colons of a message that it names twice, as "Problem" in "Problem: friction: Problem: ..."."""
    places = re.findall(r"(?:^|: )([A-Za-z_][\w.-]{2,40})(?=: )", text)
    return {one for one in places if places.count(one) > 1}


@contextmanager
def refused(*parts: str, begins: str = "") -> Iterator[None]:
    """Fail unless what is done inside is refused, in one printable line that begins as is said and has these parts."""
    with pytest.raises(InputError) as told:
        yield
    text = str(told.value)
    assert text.isprintable(), text
    assert text.startswith(begins), text
    assert all(part in text for part in parts), text
