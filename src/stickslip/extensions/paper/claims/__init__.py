"""The claims of the paper, by number, and the functions that measure them."""

from __future__ import annotations

from stickslip.extension import is_there
from stickslip.extensions.paper.cases import Runs
from stickslip.extensions.paper.claims import faults, inertia, rate_law, rules, slip_law  # noqa: F401  # they fill MEASUREMENTS
from stickslip.extensions.paper.claims.verdict import MEASUREMENTS, ClaimVerdict, MeasuredNumber, Outcome

if is_there("chains"):
    from stickslip.extensions.paper.claims import chains  # noqa: F401

STATEMENTS = {number: statement for number, (statement, _) in sorted(MEASUREMENTS.items())}
"""The claims in our words, by number."""
CLAIMS = {number: measure for number, (_, measure) in sorted(MEASUREMENTS.items())}
"""The function that measures each claim, by the number of the claim."""

__all__ = ["CLAIMS", "STATEMENTS", "ClaimVerdict", "MeasuredNumber", "Outcome", "Runs"]
