"""The bodies: a block on a spring and slabs, of one layer or several, that slide; a disc on a spring and a string that turn."""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
