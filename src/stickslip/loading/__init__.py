"""What varies in time: `ss.loading.Steps(...)`, `ss.loading.record(...)`.

`__init__.pyi` lists the names; each is imported when it is first used.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
