"""The figures of a run of a chain, as users call them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from stickslip.extensions.chains.magnitudes import magnitudes
from stickslip.extensions.chains.statistics import gutenberg_richter
from stickslip.foundation.arguments import NamesAttributes
from stickslip.solution import known_to_pyplot

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stickslip.extensions.chains.run import ChainRun
    from stickslip.foundation.place import Place


class ChainPlots(NamesAttributes):
    """Figures of the run of a chain: `run.plot()` draws its catalogue, `run.plot.rupture()` which blocks slip when.

    All but `animation` take the keywords of `Solution.plot`: `ax` (figures of one panel), `figure`, `size` and `dpi`.
    """

    def __init__(self, run: ChainRun) -> None:
        self._run = run

    def __call__(self, **place: Unpack[Place]) -> Figure:
        """Draw the catalogue."""
        return self.catalogue(**place)

    def catalogue(self, **place: Unpack[Place]) -> Figure:
        """Draw moment (m), and number of blocks that slipped, of each event against time."""
        from stickslip.extensions.chains.figures.catalogue import draw_catalogue

        return known_to_pyplot(draw_catalogue(self._run, **place), place)

    def rupture(
        self, event: int | None = None, start: float | None = None, end: float | None = None, **place: Unpack[Place]
    ) -> Figure:
        """Draw when each block slips in an event (its number; the default is that of the largest moment), or between times (s)."""
        from stickslip.extensions.chains.figures.rupture import draw_rupture

        return known_to_pyplot(draw_rupture(self._run, event, start, end, **place), place)

    def frequency(
        self, completeness: float | None = None, *, largest: float | None = None, **place: Unpack[Place]
    ) -> Figure | Axes:
        """Draw how many events have a magnitude mu = ln M or a larger one, with the slope that `gutenberg_richter` finds."""
        from stickslip.extensions.chains.figures.frequency import draw_frequency

        found: Any = gutenberg_richter(magnitudes(self._run), completeness, largest=largest)
        return known_to_pyplot(draw_frequency(found, **place), place)

    def energy(self, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the energies in springs, of heat and in dashpots, and the work of the driver, against time."""
        from stickslip.extensions.chains.figures.energy import draw_chain_energy

        return known_to_pyplot(draw_chain_energy(self._run, **place), place)

    def animation(
        self,
        path: str | Path,
        start: float | str | None = None,
        end: float | str | None = None,
        *,
        event: int | None = None,
        frames: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Path:
        """Write an animation of slip and slip rate of all blocks to a .gif, .mp4 or .webm, and return the path.

        The last two need ffmpeg. The animation shows an event (its number; the default is that of the largest moment), or the
        times from `start` to `end` (s, or texts with a unit), in 150 `frames`, unless another number is given, 20 per second.
        Blocks that move are marked, and slip is that since the first frame. `progress` is called with the number of finished
        frames and the number of all frames. Raises InputError if there is no such event or time, for fewer than two frames, and if
        the software that writes such a file is missing.
        """
        from stickslip.extensions.chains.figures.film import write_film

        return write_film(self._run, path, (event, start, end), frames, progress)
