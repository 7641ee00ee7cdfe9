"""What is not known of the loading of a record becomes free in a fit where it matters, and is fixed again."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stickslip.extensions.inference.fit.free import Free
from stickslip.extensions.inference.fit.model import Model
from stickslip.foundation.arrays import Floats

FELT = 0.3
"""A number counts if its standard deviation changes the residuals by this many standard deviations in all."""
LOOSENED_NUMBERS = 24
"""Largest number of such numbers that are free in a fit."""


@dataclass(frozen=True)
class Loosened:
    """A model in which what is not known of the loading is free too, if it matters; `added` are the values where it begins."""

    model: Model
    added: Floats

    def whole(self, searched: Floats) -> Floats:
        """Return searched numbers with those that were added."""
        return np.append(searched, self.added)


def loosened(model: Model, searched: Floats) -> Loosened:
    """Return the model with those numbers of its loading free whose standard deviation changes the residuals."""
    named = {(one.name, one.part) for one in model.free}
    felt = list[tuple[float, Free]]()
    if not model.of_means:
        for i, part in enumerate(model.parts):
            before = model.part_residual(searched, i)
            for one in part.asides:
                if not {(one.name, None), (one.name, i)} & named and one.prior is not None:
                    by = one.start + one.prior.second
                    changed = replace(part, asides=tuple(replace(each, start=by) if each is one else each for each in part.asides))
                    after = model.with_(parts=(*model.parts[:i], changed, *model.parts[i + 1 :])).part_residual(searched, i)
                    felt.append((float(np.linalg.norm(after - before)), replace(one, part=i)))
    chosen = [one for size, one in sorted(felt, key=lambda pair: -pair[0])[:LOOSENED_NUMBERS] if size > FELT]
    order = [one for _, one in felt if any(one is each for each in chosen)]
    added = np.array([one.searched(one.start) for one in order])
    return Loosened(model.with_(free=(*model.free, *order)), added)


def settled(model: Model, searched: Floats) -> tuple[Model, Floats]:
    """Return the model with what is not known of its loading fixed at the values found, and the other searched numbers."""
    values = {one.label: value for one, value in zip(model.free, model.values(searched), strict=True) if one.aside}
    parts = [
        replace(part, asides=tuple(replace(one, start=values.get(replace(one, part=i).label, one.start)) for one in part.asides))
        for i, part in enumerate(model.parts)
    ]
    free = tuple(one for one in model.free if not one.aside)
    return model.with_(parts=tuple(parts), free=free), searched[: len(free)]
