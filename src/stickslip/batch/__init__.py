"""Batches: many members of one scenario run in compiled code and parallel threads; each run is reduced to a few numbers."""

from stickslip.batch.batch_support import QUANTITIES, why_not
from stickslip.batch.run import Members, run_members

__all__ = ["QUANTITIES", "Members", "run_members", "why_not"]
