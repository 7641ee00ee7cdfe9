"""Constants of the whole package."""

YEAR = 31_557_600.0
"""Length of the Julian year, in s."""
