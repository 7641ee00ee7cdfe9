"""Batches: many members of one scenario run in compiled code and parallel threads; each run is reduced to a few numbers."""

from stickslip.engine.lanes import QUANTITIES, why_not
from stickslip.extensions.sweeps.batch.run import BatchResult, run_members

__all__ = ["QUANTITIES", "BatchResult", "run_members", "why_not"]
