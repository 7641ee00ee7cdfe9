"""Independent answers for the slab whose friction varies along the contact, in 2D and 3D: a slow method and closed forms.

They share no code with the solver under `stickslip.planar`. Tests have a second slow method, `tests/reference/convolution.py`.
"""

from stickslip.reference.planar.setting import LawAtNodes, PlanarCase, PlanarSeries, SlipWeakeningAtNodes
from stickslip.reference.planar.volume import Volume, volume

__all__ = ["LawAtNodes", "PlanarCase", "PlanarSeries", "SlipWeakeningAtNodes", "Volume", "volume"]
