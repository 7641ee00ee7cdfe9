"""Quantities that are computed from the history of a run."""
