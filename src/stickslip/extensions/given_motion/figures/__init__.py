"""Figures of given motion: friction along it, and friction as it was measured with the law that fits it."""
