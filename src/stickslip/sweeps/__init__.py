"""Sweeps: a problem over many values of its numbers."""
