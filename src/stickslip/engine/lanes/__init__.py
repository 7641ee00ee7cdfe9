"""Provide the compiled functions of a batch. Like an edit in `engine`, any edit here makes the engine compile anew.

`__init__.pyi` lists what others take from here.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
