"""Write the tour as a folder: one page, the scripts of Bokeh, and for each step the answers at the places of its strip."""

from __future__ import annotations

import json
import math
import zlib
from base64 import b64encode
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from importlib.resources import files
from pathlib import Path
from string import Template
from typing import Any

import numpy as np

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.model.strip import setting_at, strip_of
from stickslip.extensions.explorer.model.tour import TOUR, TourStep
from stickslip.extensions.explorer.page.components import asset, look, player_script, style_sheet
from stickslip.extensions.explorer.page.page import TITLES_OF_PANELS
from stickslip.extensions.explorer.page.panels import plots, view_of
from stickslip.extensions.explorer.page.panels.loading import TEXTS_OF_LOADING
from stickslip.extensions.explorer.page.panels.motion import FURTHER
from stickslip.extensions.explorer.page.stage import Stage
from stickslip.extensions.explorer.page.strip import place_of, view_of_strip
from stickslip.extensions.explorer.page.strip import plots as strip_plots
from stickslip.extensions.explorer.page.view import View, headings_of
from stickslip.extensions.explorer.page.words import told_steps, words_of
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import readable_unit
from stickslip.foundation.show import number

SHORT_COLUMN = 8
"""Columns of at most this many numbers are written as they are."""
LARGEST_PACKED = {8: 2**8 - 2, 16: 2**16 - 2}
"""The largest whole number of a packed column by its bits; the one after it stands for NaN."""
COARSE = {"velocity", "stress"}
"""Images that are only drawn in colours: 8 bits are enough for them."""


def packed_view(view: View) -> dict[str, Any]:
    """Return a view as tables and lists for JSON, which `static.js` unpacks."""
    return {
        "columns": {source: packed_columns(columns) for source, columns in view.columns.items()},
        "limits": view.limits,
        "labels": view.labels,
        "hidden": sorted(view.hidden),
        "fastest": view.fastest or 1.0,
        "facts": view.facts,
    }


def packed_columns(columns: Mapping[str, Any]) -> dict[str, Any]:
    """Return the columns of one source for JSON."""
    return {name: packed(values, 8 if name in COARSE else 16) for name, values in columns.items()}


def packed(values: Any, bits: int = 16) -> Any:
    """Return one column for JSON: a list if it is short or holds lines, otherwise whole numbers in base64 with their range.

    An image, the only array in a list, also has its shape. The error is at most half a step of the range: 1e-5 of it with 16 bits,
    0.2 % with 8.
    """
    values = list(values)
    if len(values) == 1 and np.ndim(values[0]) == 2:
        return _quantised(np.asarray(values[0], float), bits) | {"shape": list(np.shape(values[0]))}
    if any(np.ndim(one) for one in values):
        return [_numbers(np.asarray(one, float)) for one in values]
    found = np.asarray(values, float)
    return _numbers(found) if found.size <= SHORT_COLUMN else _quantised(found, bits)


def _numbers(values: Any) -> list[float | None]:
    return [None if number != number else float(f"{number:.7g}") for number in values.tolist()]


def _quantised(values: Any, bits: int) -> dict[str, Any]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
    scale = LARGEST_PACKED[bits] / (high - low) if high > low else 0.0
    whole = np.where(np.isfinite(values), np.rint((values - low) * scale), LARGEST_PACKED[bits] + 1)
    text = b64encode(whole.astype(f"<u{bits // 8}").tobytes()).decode("ascii")
    return {"bits": bits, "low": low, "high": high, "whole": text}


def script(name: str, number: int, content: Any) -> str:
    """Return a script that hands some content to a function: a page that is opened from a disk may read no other files."""
    text = json.dumps(content, allow_nan=False, separators=(",", ":"))
    return f'{name}({number},"{b64encode(zlib.compress(text.encode(), 9)).decode("ascii")}")\n'


STRIP_PLACES = 25
"""Each strip has a stored answer at this many places, besides that of the step itself."""
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


def content_of(step: TourStep, places: int) -> dict[str, Any]:
    """Return what the page needs of a step: its strip, and what the panels show at each place of it."""
    setting = step.setting
    assert step.strip is not None
    strip = strip_of(setting.scenario(), step.strip)
    kept = np.union1d(replace(step.strip, points=places).values, [strip.here])
    unit, size = readable_unit(strip.unit, strip.values, log=strip.log)
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
    return {"words": words_of(answer), "view": packed_view(view) | {"headings": headings_of(view, TITLES_OF_PANELS)}}


# ---- the page ---------------------------------------------------------------------------------------------------------------


@cache
def library() -> bytes:
    """Return the script of Bokeh, from the package that is installed."""
    return (files("bokeh") / "server" / "static" / "js" / LIBRARY).read_bytes()


def index_page() -> str:
    """Return the page, with the plots as Bokeh describes them and without data."""
    from bokeh.embed import components

    stages = Stage(), Stage()
    never = FURTHER | TEXTS_OF_LOADING  # no step has a state, a record or a loading history
    shown = {name: plot for name, plot in plots(stages[0]).items() if name not in never}
    models = shown | {f"strip_{name}": plot for name, plot in strip_plots(stages[1]).items()}
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
    return (files("stickslip.extensions.explorer.static") / "assets" / name).read_text(encoding="utf-8")


def _module(text: str, *names: str) -> str:
    return f"{text}\nObject.assign(window, {{ {', '.join(names)} }});"


def _in_script(value: Any) -> str:
    """Return a value as JSON that cannot end the script it stands in."""
    assert not isinstance(value, float) or math.isfinite(value)
    return json.dumps(value, allow_nan=False).replace("</", "<\\/")
