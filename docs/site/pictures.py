"""Say in words what a figure shows, for those who do not see it."""

from __future__ import annotations

import re
from typing import Any

from matplotlib import pyplot
from matplotlib.figure import Figure
from sphinx_gallery.scrapers import matplotlib_scraper


def in_words(figure: Figure) -> str:
    """Return the titles of a figure, without the letters of its panels, and what each panel draws against what."""
    panels = [one for one in figure.axes if one.get_label() != "<colorbar>"]
    titles = [figure.get_suptitle(), *(one.get_title(loc) for one in panels for loc in ("left", "center", "right"))]
    drawn = [(one.get_ylabel(), one.get_xlabel()) for one in panels]
    texts = [re.sub(r"^\(\w\)\s*", "", title) for title in titles]
    for place, (y, _) in enumerate(drawn):
        below = next((x for _, x in drawn[place:] if x), "")  # panels that share an axis name it once, below the last
        texts += [f"{y} against {below}"] if y else []
    return "; ".join(" ".join(re.sub(r"[$\\]", "", text).split()) for text in dict.fromkeys(texts) if text)


def scrape(*block: Any) -> str:
    """Save the figures of a block of an example as sphinx-gallery does, and let the texts that stand for them be these words."""
    words = iter([in_words(pyplot.figure(number)) for number in pyplot.get_fignums()])
    return re.sub(r":alt: .*", lambda _: f":alt: {next(words)}", matplotlib_scraper(*block))


def _get_sg_image_scraper() -> Any:
    """Return what sphinx-gallery looks for in a module that saves pictures."""
    return scrape
