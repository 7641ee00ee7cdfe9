"""The notebook for teachers: its cells run in order, and its questions take the closed forms as answers and nothing else."""

from __future__ import annotations

import json
import math
import re
import warnings
from pathlib import Path
from typing import Any

import matplotlib as mpl
import pytest
from matplotlib import pyplot

NOTEBOOK = Path(__file__).parents[2] / "examples" / "lessons" / "stick-slip-lesson.ipynb"
ANSWERS = {
    "my_slip": 2 * 0.2 * 1e6 / 1.15e8,
    "my_duration": math.pi * math.sqrt(3650.0 / 1.15e8),
    "my_rate": 0.3 * 100e6 / (2800 * 3500),
    "my_stop": 2 * 10e3 / 3500,
    "my_alpha": 2800 * 3500 / (100e6 * 0.5),
}


def cells() -> list[str]:
    book = json.loads(NOTEBOOK.read_text(encoding="utf-8"))
    assert (book["nbformat"], book["nbformat_minor"]) == (4, 5)
    assert len({cell["id"] for cell in book["cells"]}) == len(book["cells"])
    code = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in code), "kept without outputs"
    return ["".join(cell["source"]) for cell in code]


def run(texts: list[str]) -> dict[str, Any]:
    mpl.use("agg")
    names: dict[str, Any] = {"__name__": "__main__"}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for text in texts:
            exec(compile(text, NOTEBOOK.name, "exec"), names)
    pyplot.close("all")
    return names


def test_cells_run_in_order_without_an_answer(capsys: pytest.CaptureFixture[str]) -> None:
    names = run(cells())
    assert capsys.readouterr().out.count("no answer yet") == len(ANSWERS)
    assert [round(year, 1) for year in names["years"].values()] == [468.8, 468.8, 394.3, 378.3]


@pytest.mark.parametrize(("factor", "verdict"), [(1.0, "is right"), (1.02, "is not right")])
def test_closed_forms_are_the_answers(factor: float, verdict: str, capsys: pytest.CaptureFixture[str]) -> None:
    texts = [
        re.sub(r"^(my_\w+) = None", lambda found: f"{found[1]} = {factor * ANSWERS[found[1]]!r}", one, flags=re.MULTILINE)
        for one in cells()
    ]
    run([texts[0], *(one for one in texts if "my_" in one and "plot" not in one)])
    said = [line for line in capsys.readouterr().out.splitlines() if verdict in line]
    assert len(said) == len(ANSWERS)
