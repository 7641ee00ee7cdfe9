"""Studies that answer one question about a problem, mostly by running it several times: `ss.studies.compare(...)`.

The results of studies that run a problem draw themselves with `.plot()`. `__init__.pyi` lists the names; each is imported when it
is first used.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
