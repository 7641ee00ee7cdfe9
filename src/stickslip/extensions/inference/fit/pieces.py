"""The residuals of each quantity in all parts of a record, with the rows of a matrix that belong to them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from stickslip.extensions.inference.fit.memory import ResidualBlock
from stickslip.extensions.inference.fit.model import Model
from stickslip.foundation.arrays import Floats


class QuantityPiece(NamedTuple):
    """One quantity in all parts: residuals, rows of a matrix, weights of the samples, and blocks of neighbouring samples."""

    name: str
    residual: Floats
    rows: Floats
    weight: Floats
    blocks: list[ResidualBlock]


def pieces_of(model: Model, residual: Floats, matrix: Floats) -> Iterator[QuantityPiece]:
    """Yield the residuals of each quantity with the rows of a matrix that belong to them."""
    blocks_of = [model.blocks(i) for i in range(len(model.parts))]
    begins = np.append(0, np.cumsum([blocks[-1][1].rows.stop for blocks in blocks_of]))
    for name in model.sizes:
        blocks, places, weights, count = list[ResidualBlock](), list[Floats](), list[Floats](), 0
        for i, part in enumerate(model.parts):
            for quantity, block in blocks_of[i]:
                if quantity == name:
                    length = block.rows.stop - block.rows.start
                    places.append(begins[i] + np.arange(block.rows.start, block.rows.stop))
                    weights.append(model.weights(i)[np.isfinite(part.record.measured[name][:: model.every])])
                    blocks.append(ResidualBlock(slice(count, count + length), block.time))
                    count += length
        rows = np.concatenate(places)
        yield QuantityPiece(name, residual[rows], matrix[rows], np.concatenate(weights), blocks)
