"""Read and write files: solutions as netCDF, catalogues, and time series in the format of rupture modellers.

`__init__.pyi` lists what others take from here.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
