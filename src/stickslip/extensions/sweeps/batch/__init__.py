"""Batches: many members of one scenario run in compiled code and parallel threads; each run is reduced to a few numbers."""

from stickslip.extensions.sweeps.batch.run import BatchResult, run_members
from stickslip.engine.lanes.vectorised_problem import QUANTITIES, why_not

__all__ = ["QUANTITIES", "BatchResult", "run_members", "why_not"]
