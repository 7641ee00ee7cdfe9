"""The tables of a study of regularisations: one row for each size, or one row for each jump."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from stickslip.studies.regularisations import kind_of

if TYPE_CHECKING:
    from stickslip.studies.regularise import Regularisation


def sizes_table(study: Regularisation) -> pd.DataFrame:
    """Return the table with one row for each size (see `Regularisation.table`)."""
    kind = kind_of(study.by)
    columns: dict[str, object] = {"size": study.sizes}
    if kind.parameter != "time":
        columns[kind.parameter] = [kind.value(study.problem, size) for size in study.sizes.tolist()]
    for group, found in study.differences.items():
        for rule in group:
            name = rule.replace("-", "_")
            columns[f"mean_{name}"] = [one.mean for one in found]
            columns[f"largest_{name}"] = [one.largest for one in found]
            columns[f"end_{name}"] = [one.end for one in found]
            columns[f"order_{name}"] = study.local_orders(rule)
    columns["change"] = study.changes
    columns |= {f"delay_{j + 1}": study.delays[:, j] for j in range(study.delays.shape[1])}
    columns["pieces"] = [len(run.history) for run in study.runs]
    columns["seconds"] = list(study.seconds)
    columns["status"] = [run.status.name for run in study.runs]
    return pd.DataFrame(columns)


def jumps_table(study: Regularisation) -> pd.DataFrame:
    """Return the table with one row for each jump (see `Regularisation.jumps`)."""
    shocks = study.shocks
    table = shocks[["time", "cause", "rate_before", "rate_after"]].copy()
    table["order"] = [study.delay_order(j).power for j in range(len(shocks))]
    from_rest = shocks.rate_before == 0.0
    ramped = (shocks.cause == "fold") | ((shocks.cause == "start") & (study.problem.excess == 0.0))
    table["expected"] = np.select([ramped & from_rest, ramped], ["1 (log)", "2/3"], "1")
    return table
