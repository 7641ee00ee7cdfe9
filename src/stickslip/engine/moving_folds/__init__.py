"""Branches and levels that move with slip, in compiled code."""
