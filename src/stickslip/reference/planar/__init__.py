"""Independent answers for the slab whose friction varies along the contact, in 2D and 3D: two slow methods and closed forms.

They share no code with the solver under `stickslip.planar`.
"""

from stickslip.reference.planar.convolution import convolution
from stickslip.reference.planar.setting import LawAtNodes, PlanarCase, PlanarSeries, SlipWeakeningAtNodes
from stickslip.reference.planar.volume import Volume, volume

__all__ = ["LawAtNodes", "PlanarCase", "PlanarSeries", "SlipWeakeningAtNodes", "Volume", "convolution", "volume"]
