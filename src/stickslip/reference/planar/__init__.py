"""Independent answers for the slab whose friction varies along the contact (2D and 3D, scalar waves): two slow methods, closed forms.

They share no code with the solver under `stickslip.planar`, and use numpy alone.
"""

from stickslip.reference.planar.convolution import convolution
from stickslip.reference.planar.setting import LawAtNodes, PlanarCase, PlanarSeries, SlipWeakeningAtNodes
from stickslip.reference.planar.volume import Volume, volume

__all__ = ["LawAtNodes", "PlanarCase", "PlanarSeries", "SlipWeakeningAtNodes", "Volume", "convolution", "volume"]
