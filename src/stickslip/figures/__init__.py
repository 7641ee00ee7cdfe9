"""The figures of the package: most modules have `data(...)`, which makes a dataset, and `draw(dataset)`, which draws it.

Runs and studies draw themselves (`solution.plot()`); `ss.figures` has the figures of datasets: `ss.figures.plot_sweep(dataset)`,
and of laws made from points: `ss.figures.plot_fit(result)`.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
