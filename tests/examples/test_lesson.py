"""The notebooks for teachers: cells run in order, questions take closed forms as answers and nothing else, as the page does."""

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

ROOT = Path(__file__).parents[2]
FIRST, SECOND = (ROOT / "examples" / "lessons" / f"{name}-lesson.ipynb" for name in ("stick-slip", "rate-and-state"))
ANSWERS = {
    "my_slip": 2 * 0.2 * 1e6 / 1.15e8,
    "my_duration": math.pi * math.sqrt(3650.0 / 1.15e8),
    "my_rate": 0.3 * 100e6 / (2800 * 3500),
    "my_stop": 2 * 10e3 / 3500,
    "my_alpha": 2800 * 3500 / (100e6 * 0.5),
}
ANSWERS_TO_SECOND = {
    "my_jump": 0.010 * math.log(10.0),
    "my_change": (0.010 - 0.013) * math.log(10.0),
    "my_stiffness": (0.013 - 0.010) * 50e3 / 10e-6,
    "my_rate": (71e6 - 50e6) / (2800 * 3500),
    "my_news": 4e3 / 3500,
}
LESSONS = [(FIRST, ANSWERS), (SECOND, ANSWERS_TO_SECOND)]


def cells(notebook: Path) -> list[str]:
    book = json.loads(notebook.read_text(encoding="utf-8"))
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
            exec(compile(text, "lesson", "exec"), names)
    pyplot.close("all")
    return names


def test_cells_of_the_first_lesson_run_in_order_without_an_answer(capsys: pytest.CaptureFixture[str]) -> None:
    names = run(cells(FIRST))
    assert capsys.readouterr().out.count("no answer yet") == len(ANSWERS)
    assert [round(year, 1) for year in names["years"].values()] == [468.8, 468.8, 394.3, 378.3]


@pytest.mark.slow
def test_cells_of_the_second_lesson_run_in_order_and_only_soft_machines_stick_and_slip(capsys: pytest.CaptureFixture[str]) -> None:
    run(cells(SECOND))
    said = capsys.readouterr().out
    assert said.count("no answer yet") == len(ANSWERS_TO_SECOND)
    slowest = [float(rate) for rate in re.findall(r"slip rates from (\S+) to", said)]
    assert [rate > 1.0 for rate in slowest] == [False, False, True, True], "um/s, of a pull rate of 1.2"
    assert float(re.findall(r"6 and 10 km: (\S+) km/s", said)[0]) == pytest.approx(3.5, rel=0.05)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("notebook", "answers"), LESSONS, ids=["first", "second"])
@pytest.mark.parametrize(("factor", "verdict"), [(1.0, "is right"), (1.02, "is not right")])
def test_closed_forms_are_the_answers(
    notebook: Path, answers: dict[str, float], factor: float, verdict: str, capsys: pytest.CaptureFixture[str]
) -> None:
    texts = [
        re.sub(r"^(my_\w+) = None", lambda found: f"{found[1]} = {factor * answers[found[1]]!r}", one, flags=re.MULTILINE)
        for one in cells(notebook)
    ]
    run([texts[0], *(one for one in texts[1:] if "judge(" in one)])
    said = [line for line in capsys.readouterr().out.splitlines() if verdict in line]
    assert len(said) == len(answers)


@pytest.mark.parametrize(("lesson", "answers"), [(0, ANSWERS), (1, ANSWERS_TO_SECOND)], ids=["first", "second"])
def test_the_page_for_teachers_has_the_answers(lesson: int, answers: dict[str, float]) -> None:
    """What its examples print, which tests of the pages run, is what the lesson's closed forms say."""
    _, *parts = (ROOT / "docs" / "teaching.md").read_text("utf-8").split("## Answers to the ")
    shown = re.findall(r"^\d\. ([-\d.e+]+) ?(\S*)$", parts[lesson], re.MULTILINE)
    sizes = {"mm": 1e-3, "ms": 1e-3}
    numbers = [float(number) * sizes.get(unit, 1.0) for number, unit in shown]
    assert numbers == pytest.approx(list(answers.values()), rel=5e-4)
