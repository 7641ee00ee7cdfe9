"""The figures of the package: most modules make a dataset (`energy_data`) and draw it (`draw_energy`).

Runs and studies draw themselves (`solution.plot()`); `ss.figures` has the figures of datasets: `ss.figures.plot_sweep(dataset)`,
and of laws made from points: `ss.figures.plot_fit(result)`.

- `style`, `names`: colours, units, labels that carry their units, and the names of parameters.
- `sheet`: where a figure is drawn, and how large it is.
- `panels`: titles, letters, keys, scales, and panels of one kind.
- `page`: the frame of reports in HTML, and how they write numbers.
- `runs`, `contact`: the figures of single runs and of the contact, a module each.
"""

from stickslip.foundation.lazy_names import lazy_names

__getattr__, __dir__ = lazy_names(__name__, __file__)
