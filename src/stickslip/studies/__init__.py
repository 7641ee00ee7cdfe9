"""Studies that answer one question about a problem, mostly by running it several times: `ss.studies.compare(...)`.

The results of studies that run a problem draw themselves with `.plot()`. `__init__.pyi` lists the names; each is imported when it
is first used.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
