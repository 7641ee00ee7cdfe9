"""The compiled engine, which works on numbers and addresses and never sees a `Problem`.

`__init__.pyi` lists what others take from here.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
