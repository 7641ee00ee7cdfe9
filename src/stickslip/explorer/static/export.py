"""Write the tour as a folder: one page, the scripts of Bokeh, and for each step the answers at the places of its strip."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from stickslip.explorer.model.answer import Answer
from stickslip.explorer.model.solve import solve
from stickslip.explorer.model.strip import setting_at, strip_of
from stickslip.explorer.model.tour import TOUR, Step
from stickslip.explorer.page.components import asset, look, player_script
from stickslip.explorer.page.look import style_sheet
from stickslip.explorer.page.page import TITLES
from stickslip.explorer.page.panels import plots, view_of
from stickslip.explorer.page.stage import Stage
from stickslip.explorer.page.strip import place_of, view_of_strip
from stickslip.explorer.page.strip import plots as strip_plots
from stickslip.explorer.page.tour import told_steps
from stickslip.explorer.page.view import headings_of
from stickslip.explorer.page.words import words_of
from stickslip.explorer.static.packing import packed_view, script
from stickslip.figures.style import unit_of
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import number

STRIP_PLACES = 25
"""Number of places of each strip at which an answer is kept, beside that of the step itself."""
LIBRARY = "bokeh.min.js"
"""The script of Bokeh that draws the plots."""
READ_ME = """The tour of the stickslip explorer. Open index.html in a browser: it needs no network and no server.
The folder may be copied anywhere, or be put on a web server as it is.
"""


@dataclass(frozen=True)
class Written:
    """What has been written: the folder, its size in bytes, and the number of answers in it."""

    folder: Path
    size: int
    answers: int

    def __str__(self) -> str:
        told = f"the tour of {len(TOUR)} steps with {self.answers} answers, {self.size / 1e6:.1f} MB"
        return f"{self.folder}: {told}; open index.html in it"


def write_tour(folder: Path, told: Callable[[str], object] = lambda text: None, places: int = STRIP_PLACES) -> Written:
    """Write the tour into a new folder, under a temporary name until it is complete.

    `told` is called with a line on the progress for each step; at `places` of each strip an answer is kept. Raises InputError if
    something else has this name, or the folder above does not exist, and OSError if it cannot be written.
    """
    check_folder(folder)
    answers = 0

    def write(draft: Path) -> None:
        nonlocal answers
        (draft / "data").mkdir()
        for i, step in enumerate(TOUR, 1):
            told(f"step {i} of {len(TOUR)}: {step.title}")
            content = content_of(step, places)
            answers += len(content["places"])
            (draft / "data" / f"step-{i}.js").write_text(script("stickslipStep", i, content), encoding="utf-8")
        (draft / LIBRARY).write_bytes(library())
        (draft / "README.txt").write_text(READ_ME, encoding="utf-8")
        (draft / "index.html").write_text(index_page(), encoding="utf-8")
        if folder.is_dir():
            folder.rmdir()

    write_atomically(folder, write, folder=True)
    size = sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())
    return Written(folder, size, answers)


def check_folder(folder: Path) -> None:
    """Refuse a name under which no new folder can be made. Raises InputError."""
    if not folder.absolute().parent.is_dir():
        raise InputError(f"explore: --static {folder}: there is no folder {folder.parent}")
    if folder.is_symlink() or (folder.exists() and not (folder.is_dir() and not any(folder.iterdir()))):
        raise InputError(f"explore: --static {folder}: this exists already: choose another name, or remove it first")


# ---- the answers ------------------------------------------------------------------------------------------------------------


def content_of(step: Step, places: int) -> dict[str, Any]:
    """Return what the page needs of a step: its strip, and what the panels show at each place of it."""
    setting = step.setting
    strip = strip_of(setting.scenario(), step.strip)
    kept = np.union1d(step.strip.values(places), [strip.here])
    unit, size = unit_of(strip.unit, strip.values, log=strip.log)
    shown = view_of_strip(strip)
    return {
        "parameter": strip.parameter,
        "meaning": strip.meaning,
        "unit": "" if unit == "1" else unit,
        "strip": packed_view(shown) | {"headings": headings_of(shown, dict.fromkeys(shown.titles, ""))},
        "start": int(np.searchsorted(kept, strip.here)),
        "cursor": step.cursor,
        "places": [
            {
                "at": float(place_of(strip, value, size)),
                "value": number(value / size, 4),
                **shown_of(solve(setting_at(setting, strip.parameter, value).scenario())),
            }
            for value in kept.tolist()
        ],
    }


def shown_of(answer: Answer) -> dict[str, Any]:
    """Return what the panels and the sentence show of an answer."""
    view = view_of(answer)
    return {"words": words_of(answer), "view": packed_view(view) | {"headings": headings_of(view, TITLES)}}


# ---- the page ---------------------------------------------------------------------------------------------------------------


@cache
def library() -> bytes:
    """Return the script of Bokeh, from the package that is installed."""
    return (files("bokeh") / "server" / "static" / "js" / LIBRARY).read_bytes()


def index_page() -> str:
    """Return the page, with the plots as Bokeh describes them and without data."""
    from bokeh.embed import components

    stages = Stage(), Stage()
    models = plots(stages[0]) | {f"strip_{name}": plot for name, plot in strip_plots(stages[1]).items()}
    made, places = components(models, wrap_script=False)
    facts = {"look": look(), "steps": told_steps()}
    return Template(_asset("index.html")).substitute(
        style=style_sheet() + "\n".join(asset(name) for name in ("page.css", "heading.css")) + _asset("static.css"),
        library=LIBRARY,
        plots=made,
        player=_module(player_script(), "Player", "imageOf", "showColumns"),
        card=_module(asset("tour.js"), "TourCard"),
        words=asset("words.js") + "\nwindow.Words = render;",
        words_css=_in_script(asset("words.css")),
        player_css=_in_script(asset("player.css")),
        card_css=_in_script(asset("tour.css")),
        facts=_in_script(facts),
        static=_asset("static.js"),
        **{f"plot_{name}": place for name, place in places.items()},
    )


def _asset(name: str) -> str:
    return (files("stickslip.explorer.static") / "assets" / name).read_text(encoding="utf-8")


def _module(text: str, *names: str) -> str:
    return f"{text}\nObject.assign(window, {{ {', '.join(names)} }});"


def _in_script(value: Any) -> str:
    """Return a value as JSON that cannot end the script it stands in."""
    assert not isinstance(value, float) or math.isfinite(value)
    return json.dumps(value, allow_nan=False).replace("</", "<\\/")
