"""A small sweep that clusters carry out; half of its members fail."""

from __future__ import annotations

import numpy as np

from stickslip.extensions.sweeps.execution.plan import Plan, make_plan

VARY = {
    "friction.alpha": np.linspace(0.05, 2.0, 6),
    "loading.far_stress_rate": [0.0, "1 Pa/s"],
    "run.selection": ["maxwell", "perfect-delay"],
}
"""A rigid driver takes no far stress: half of the members fail."""


def plan_of(chunk: int) -> Plan:
    """Return the plan of the sweep with `chunk` members in a chunk."""
    return make_plan("fig6-slab", VARY, quantities=["slip", "pulses"], series=["slip"], samples=5, chunk=chunk)
