"""Many numbers as one text, to the last bit: what a scenario holds in place of a list that nobody reads."""

from __future__ import annotations

import base64
import binascii
import re
import zlib
from collections.abc import Sequence

import numpy as np

from stickslip.foundation.errors import InputError
from stickslip.foundation.given import Given, column_given

_FORM = re.compile(r"(\d{1,9}) numbers(?: given in ([^:\n]{1,40}))?, float64, zlib, base64: ([A-Za-z0-9+/]+={0,2})")
BYTES = 8
"""Bytes of a number of double precision."""


def packed(numbers: Sequence[float]) -> str:
    """Return numbers as a text, which says in which unit they were given, if they remember one."""
    unit = next((one.unit for one in numbers if isinstance(one, Given)), "")
    content = base64.b64encode(zlib.compress(np.array(numbers, "<f8").tobytes(), 9)).decode()
    return f"{len(numbers)} numbers{f' given in {unit}' if unit else ''}, float64, zlib, base64: {content}"


def unpacked(text: str, si: str, most: int) -> list[float]:
    """Return the numbers (in `si`) in a text that `packed` made. Raises InputError, meant to follow "must be ..., got "."""
    form = _FORM.fullmatch(text)
    if form is None:
        raise InputError("a text that is not one of packed numbers")
    count = int(form[1])
    if count > most:
        raise InputError(f"{count} packed numbers, where {most} are allowed")
    try:
        reader = zlib.decompressobj()
        content = reader.decompress(base64.b64decode(form[3], validate=True), BYTES * count + 1)
    except (binascii.Error, zlib.error):
        raise InputError("packed numbers that are damaged") from None
    if len(content) != BYTES * count or not reader.eof:
        raise InputError(f"packed numbers that are damaged: they are not {count}")
    numbers: list[float] = np.frombuffer(content, "<f8").tolist()
    return column_given(numbers, form[2], si) if form[2] else numbers
