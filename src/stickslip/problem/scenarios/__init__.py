"""Scenarios: TOML files that say what to simulate, and those that come with the package.

`__init__.pyi` lists what others take from here.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
