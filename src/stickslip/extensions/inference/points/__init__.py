"""Friction laws from measured points: fits of the laws that there are, and smooth curves."""
