"""The report on an inference: figures, numbers with intervals, what the record determines, and the best scenario, on one page."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.extensions.inference.figures import inference as figures
from stickslip.extensions.inference.inference import Inference, in_shown_unit, minima_of, noise_of, ranking, record_of, warnings_of
from stickslip.figures.page import DIGITS_ON_PAGE, picture, rendered, save_figure, save_text, superscript, with_unit
from stickslip.foundation.names import name_of
from stickslip.foundation.show import about_time, brief, number, sentence
from stickslip.problem import in_given_units

PAGE = "report.html"
"""Name of the page in the folder of a report."""
MOST_PAIRED = 6
"""Largest number of numbers that are drawn against each other."""


@in_given_units
def write(study: Inference, folder: Path, *others: Inference) -> Path:
    """Write page, figures, table, best scenario and all numbers to a folder, the page last, and return the path of the page.

    `others` are inferences from the same record, whose laws are compared by what they predict of the part that was left out.
    """
    compared = ranking(study, *others) if others else None
    folder.mkdir(parents=True, exist_ok=True)
    dataset = study.to_dataset()
    pictures = [_drawn(folder, *one) for one in _figures(study, dataset)]
    study.to_netcdf(folder / "inference.nc")
    study.to_csv(folder / "numbers.csv")
    scenario = study.to_toml(folder / "best.toml").read_text(encoding="utf-8")
    html = rendered(
        "stickslip.extensions.inference",
        "inference.html.j2",
        version=ss.__version__,
        study=study,
        title=_title(study),
        law=study.best.friction.kind,
        body=study.best.body.kind,
        warnings=list(warnings_of(study)),
        left=_left(study),
        known=list(_known(study)),
        about=[sentence(text) for text in (*record_of(study), *study.about_samples, *study.about)],
        tables=[table for table in (_numbers(study, own=False), _numbers(study, own=True)) if table],
        fit=_fit(study),
        prediction=None if study.prediction is None else number(study.prediction, 3),
        compared=[] if compared is None else [[_short(cell) for cell in row] for row in compared.to_numpy(object).tolist()],
        pictures=pictures,
        records=_records(study),
        scenario=scenario,
        asked=[(name, str(value)) for name, value in study.asked.items()],
        digits=DIGITS_ON_PAGE,
    )
    return save_text(folder / PAGE, html)


def _left(study: Inference) -> str:
    """Return what is left of a record that its run follows: white noise, or noise that is correlated."""
    if study.features is not None:
        return "it has the mean features of the events"
    longest = max((memory.time for memory in study.model.memory.values()), default=0.0)
    return f"what is left remembers itself for {brief(longest, 's', 3)}" if longest > 0.0 else "what is left looks like noise"


def _title(study: Inference) -> str:
    names = dict.fromkeys(Path(part.record.name).name for part in study.parts)
    return f"Fitted to {', '.join(names)}"


def _figures(study: Inference, dataset: Any) -> Iterator[tuple[str, str, str, Any]]:
    if study.features is not None:
        caption = "What was measured of each slip event, the mean with its interval of 95 %, and the run with the best numbers."
        yield "figure-features", "Features of slip events, record and best run", caption, figures.draw_features(dataset)
    for name in study.model.sizes if study.features is None else ():
        title = f"{name_of(name).capitalize()}, record and best run"
        caption = (
            "Above: the samples of the record, and the run with the best numbers. Middle: what is left, which should look like "
            "noise; a pattern is what the model lacks. Below: the slip rate of that run."
        )
        yield f"figure-{name.replace('_', '-')}", title, caption, figures.draw_curves(dataset, name)
    pairs = figures.draw_pairs(dataset, MOST_PAIRED)
    if pairs is not None:
        caption = (
            "Each pair of numbers: the ellipse holds both with a probability of 95 %, the cross is the best fit. A narrow, tilted "
            "ellipse means that a combination is known better than either number."
        )
        yield "figure-pairs", "Pairs of numbers", caption, pairs


def _drawn(folder: Path, name: str, title: str, caption: str, figure: Any) -> dict[str, str]:
    return {"name": name, "title": title, "caption": caption, "source": picture(save_figure(folder / name, figure))}


def _known(study: Inference) -> Iterator[str]:
    """Yield sentences on what the record determines, and on what it does not."""
    table = study.table
    sure = [str(name) for name, row in table.iterrows() if np.isfinite(row.uncertainty)]
    shared = [one.label for one in study.free if one.part is None]
    named = [f"{name} ({_share(table.loc[name])})" for name in shared if name in sure]
    if named:
        yield f"The record determines {_listed(named)}; in brackets half the interval of 95 %."
    yield from (sentence(note) for note in (*study.certainty.notes, *minima_of(study), *noise_of(study)))


def _share(row: Any) -> str:
    """Return half the width of an interval, as a percentage of the value or with the unit of the number."""
    half = 0.5 * (row.high - row.low)
    if row.value and half < 2.0 * abs(row.value):
        return f"± {100.0 * half / abs(row.value):.2g} %"
    return f"± {with_unit(half, '' if row.unit == '1' else row.unit)}"


def _listed(texts: list[str]) -> str:
    return texts[0] if len(texts) == 1 else f"{', '.join(texts[:-1])} and {texts[-1]}"


def _numbers(study: Inference, *, own: bool) -> list[list[str]]:
    """Return name, meaning, value, interval and its source of the numbers that all parts share, or that belong to single ones."""
    rows = []
    for one in study.free:
        if (one.part is not None) is not own:
            continue
        row: Any = in_shown_unit(one.label, study.table.loc[one.label])
        unit = "" if row.unit == "1" else row.unit.replace("1/", "/")
        determined = bool(np.isfinite(row.uncertainty))
        if determined:
            digits = _digits(row.value, row.uncertainty)
            ends = [_power(f"{end:.{digits}g}") for end in (row.low, row.high)]
            cells = [f"{_measured(row.value, row.uncertainty)} {unit}", f"{ends[0]} to {ends[1]}", str(row.source)]
        elif row.source == "bound":
            cells = [f"{_power(f'{row.value:.6g}')} {unit}", "–", "on a bound"]
        else:
            cells = ["not determined", "–", "–"]
        rows.append([one.label, one.declared.meaning.replace("`", ""), *cells, _power(f"{row.start:.4g}")])
    return rows


def _digits(value: float, uncertainty: float) -> int:
    size = max(abs(value), uncertainty, 1e-300) / max(uncertainty, 1e-300)
    return min(max(2 + math.floor(math.log10(size)), 3), 12)


def _measured(value: float, uncertainty: float) -> str:
    """Return a value with its standard uncertainty, both in one power of ten: (1.505 ± 0.005) × 10⁻⁵."""
    size = max(abs(value), uncertainty)
    power = 0 if not size or 1e-3 <= size < 1e6 else math.floor(math.log10(size))
    value, uncertainty = value / 10.0**power, uncertainty / 10.0**power
    decimals = max(1 - math.floor(math.log10(uncertainty)), 0) if uncertainty > 0.0 else DIGITS_ON_PAGE
    text = f"{value:.{decimals}f} ± {uncertainty:.{decimals}f}".replace("-", "−")
    return text if power == 0 else f"({text}) × 10{superscript(power)}"


def _power(text: str) -> str:
    """Return a number that Python has written with its power of ten as such."""
    mantissa, _, exponent = text.partition("e")
    factor = "" if mantissa == "1" else f"{mantissa} × "
    return (f"{factor}10{superscript(int(exponent))}" if exponent else mantissa).replace("-", "−")


def _fit(study: Inference) -> list[list[str]]:
    rows = []
    for name, row in study.fit.iterrows():
        unit = "" if row.unit == "1" else row.unit
        memory = about_time(row.memory) if row.memory > 0.0 else "none"
        sizes = [f"{_power(f'{value:.3g}')} {unit}".strip() for value in (row.noise, row.rms)]
        rows.append([str(name).replace("_", " "), str(row.samples), sizes[0], memory, sizes[1]])
    return rows


def _short(cell: object) -> str:
    return number(cell, 5) if isinstance(cell, float) else str(cell)


def _records(study: Inference) -> list[str]:
    found = []
    for part in study.parts:
        measured = ", ".join(name.replace("_", " ") for name in part.record.measured)
        record = part.record
        found.append(f"{record.name}: {len(record)} samples in {about_time(part.duration)}, measured: {measured}")
    return found
