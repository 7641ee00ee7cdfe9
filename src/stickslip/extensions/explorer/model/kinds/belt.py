"""What the explorer shows of rigid bodies on a belt: what it shows of those on a spring, under what a belt can do."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

from stickslip.extensions.explorer.model.kinds.rigid import ShownRigid
from stickslip.problem import LoadingHistory, Problem


class _ShownBelt(ShownRigid):
    def loading_of(self, table: dict[str, Any], own: Problem) -> dict[str, Any]:
        """Return it without ground that moves, which is the belt, and at its first pull rate if that jumps."""
        kept = {key: value for key, value in table.items() if not key.startswith("ground_")}
        pull = own.pull_rate
        if isinstance(pull, LoadingHistory) and any(
            not math.isclose(one.at(later.start), later.value, rel_tol=1e-9) for one, later in pairwise(pull.segments)
        ):
            kept["pull_rate"] = pull.first
        return kept


ANSWERS = _ShownBelt()
