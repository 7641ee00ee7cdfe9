"""The report on an inference: a page that needs no other file, with what was found, what is not determined, and what warns."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.inference.inference import Inference
from stickslip.extensions.inference.report import _digits, _measured
from tests.extensions.inference.velocity_steps import NEAR, TWO, inferred, record
from tests.html_page import Page, check_alone, check_form, check_links
from tests.pictures import blank

FREE = (*TWO, "body.mass")


@pytest.fixture(scope="module")
def found() -> Inference:
    return ss.studies.infer(NEAR, record(), FREE, starts=1, held_out="110 s")


@pytest.fixture(scope="module")
def folder(found: Inference, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "deep" / "folder"
    slip = replace(NEAR, friction=replace(NEAR.friction, evolution="slip"))
    other = ss.studies.infer(slip, record(), FREE, starts=1, held_out="110 s")
    with blank():
        assert found.report(out, other) == out / "report.html"
    return out


@pytest.fixture(scope="module")
def page(folder: Path) -> Page:
    return Page((folder / "report.html").read_text(encoding="utf-8"))


def test_the_page_needs_nothing_else_and_its_links_lead_somewhere(page: Page, folder: Path) -> None:
    check_form(page)
    check_alone(page, (folder / "report.html").read_text(encoding="utf-8"))
    links = check_links(page, folder)
    assert {"best.toml", "numbers.csv", "inference.nc", "figure-friction.png", "figure-pairs.svg"} <= set(links)
    assert all(len(one["alt"]) > 60 for one in page.having("img"))


def test_the_page_shows_the_numbers_the_best_scenario_and_the_better_law(page: Page, found: Inference) -> None:
    rows = page.within("tbody")
    for name in TWO:
        row = found.table.loc[name]
        assert name in rows
        assert _measured(row.value, row.uncertainty) in rows
    assert page.within("pre").strip() == found.scenario.to_toml().strip()
    assert rows.index("rate-and-state, ageing") < rows.index("rate-and-state, slip")
    text = " ".join(text for _, text in page.text)
    assert "what is left looks like noise" in text.casefold()
    assert "held_out = 110 s" in text


def test_a_number_without_influence_is_not_given_as_a_number(page: Page, found: Inference) -> None:
    rows = page.within("tbody")
    assert rows[rows.index("body.mass") :].startswith("body.mass mass mnot determined––20")
    assert "body.mass has no influence on what is fitted: fix it." in page.within("li")
    assert found.values["body.mass"] == pytest.approx(20.0), "the search leaves it where it was given"


def test_the_table_beside_the_page_keeps_the_names_and_all_digits(folder: Path, found: Inference) -> None:
    table = pd.read_csv(folder / "numbers.csv", comment="#", index_col="number")
    assert table.value.to_dict() == found.values
    assert ss.load_scenario(str(folder / "best.toml")).problem.friction.a == found.values["friction.a"]


@pytest.mark.slow
def test_a_second_report_replaces_the_first_and_warns_of_a_run_that_misses_the_record(folder: Path) -> None:
    data = record()
    data["mu"] += 0.02 * (data["time (min)"] > 2.5)
    study = inferred(data, ["friction.a"])
    with blank():
        page = Page(study.report(folder).read_text(encoding="utf-8"))
    assert page.having("ul")[0] == {"class": "warnings", "aria-label": "Warnings"}
    assert "the run misses features of friction" in page.within("li")
    check_links(page, folder)


@pytest.mark.parametrize(
    ("value", "uncertainty", "expected"),
    [
        (1.5077e-5, 7.0e-8, "(1.5077 ± 0.0070) × 10⁻⁵"),
        (0.62000072, 9.9e-6, "0.6200007 ± 0.0000099"),
        (-5.0, 0.3, "−5.00 ± 0.30"),
        (5.997e7, 5.2e5, "(5.997 ± 0.052) × 10⁷"),
        (0.0, 2e-5, "(0.0 ± 2.0) × 10⁻⁵"),
    ],
)
def test_values_have_the_digits_that_their_uncertainty_leaves(value: float, uncertainty: float, expected: str) -> None:
    assert _measured(value, uncertainty) == expected


def test_ends_of_intervals_have_two_uncertain_digits() -> None:
    assert (_digits(1.5077e-5, 7e-8), _digits(0.62, 1e-5), _digits(1.0, 3.0)) == (4, 6, 3)
