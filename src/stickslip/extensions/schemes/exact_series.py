"""The exact series of a scenario as a dataset, with its events and shocks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import stickslip
from stickslip.foundation.names import in_files
from stickslip.problem.scenarios import Scenario
from stickslip.run.simulate import simulate

if TYPE_CHECKING:
    import xarray as xr

RTOL_OF_EXACT = 1e-12
"""Relative tolerance of the exact series."""
INTERVALS = 4000
"""Number of equal intervals of time in a series."""


def dataset_of(scenario: Scenario) -> xr.Dataset:
    """Return the exact series of a scenario: time, slip since t = 0, slip rate and traction, and its events and shocks.

    At each shock there are two rows of the same time, with the values before it and after it.
    """
    run = simulate(scenario)
    shocks = run.shocks[["time", "rate_before", "rate_after", "traction_before", "traction_after"]]
    at = shocks.time.to_numpy(float)
    uniform = np.unique(np.concatenate([np.linspace(0.0, run.history.span[1], INTERVALS + 1), at]))
    sides = [(at, "left"), (uniform, "right")]
    time = np.concatenate([times for times, _ in sides])
    order = np.argsort(time, kind="stable")  # stable: the values before a shock come first
    rate = np.concatenate([run.slip_rate(times, side) for times, side in sides])  # type: ignore[arg-type]
    traction = np.concatenate([run.traction(times, side) for times, side in sides])  # type: ignore[arg-type]
    table = shocks.rename(columns=lambda column: f"shock_{column}").rename_axis("shock")
    events = run.events[["start", "end", "slip", "peak_rate", "pulses"]].rename(columns=lambda column: f"event_{column}")
    found = table.to_xarray().merge(events.rename_axis("event").to_xarray())
    values = {"time": time, "slip": run.slip(time) - run.problem.initial_slip, "slip_rate": rate, "traction": traction}
    units = {"time": "s"} | {name: run.problem.unit_of(name) for name in ("slip", "slip_rate", "traction")}
    found = found.assign({column: ("sample", values[column][order], {"units": in_files(unit)}) for column, unit in units.items()})
    about = {"title": scenario.title, "asks": scenario.description, "rtol": scenario.rtol, "version": stickslip.__version__}
    return found.assign_attrs(**about, rule=run.problem.rule, scenario=scenario.to_toml())
