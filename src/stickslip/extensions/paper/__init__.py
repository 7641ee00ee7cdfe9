"""Reproduction of the paper: its figures, tables, and a verdict on each claim. `make(folder)` writes everything."""

from stickslip.paper.make import make

__all__ = ["make"]
