"""Which cases of a test with `sampled(every=N)` are run: one of each N cases that follow each other, as the draw says."""

from __future__ import annotations

import random

FIRST = "first"
"""The draw of `make test`: the first of each N cases, so that every machine runs the same tests."""


def drawn(test: str, cases: int, every: int, draw: str) -> frozenset[int]:
    """Return the numbers of the cases of a test that are run.

    Any other draw than `FIRST` is the seed of a generator, one for each test: the same seed draws the same cases again.
    """
    blocks = [range(start, min(start + every, cases)) for start in range(0, cases, every)]
    if draw == FIRST:
        return frozenset(block[0] for block in blocks)
    generator = random.Random(f"{draw} {test}")
    return frozenset(generator.choice(block) for block in blocks)
