"""Run a problem: with its whole history, resumed after a stop, or as a table of slip events alone.

`__init__.pyi` lists what others take from here.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
