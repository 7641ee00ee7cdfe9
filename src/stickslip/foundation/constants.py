"""Constants of the whole package."""

YEAR = 31_557_600.0
"""Length of the Julian year, in s."""
RIGID, DEAD_LOAD = -1.0, 1.0
"""Reflection coefficients (1) of a driver that prescribes its displacement and of one that prescribes its traction."""
PAPER = "Campillo, Ionescu, Paumier, Renard 1996, Phys. Earth Planet. Inter. 96, 15-23"
"""The paper whose system this is, as files refer to it."""
GRAVITY = 9.80665
"""Standard acceleration of gravity, in m/s^2: what the unit g stands for."""
