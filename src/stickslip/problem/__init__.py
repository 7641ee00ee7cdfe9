"""Define problems: a body, a friction law, the loading, the initial state, and the rule that selects a slip rate.

`__init__.pyi` lists what others take from here.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
