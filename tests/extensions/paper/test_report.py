"""The page with the report on the paper: its structure, its links, and the numbers that readers see."""

from __future__ import annotations

import re
import subprocess
import sys
from base64 import b64decode
from pathlib import Path

import pandas as pd
import pytest
import xarray as xr

from stickslip.extensions.paper.claims import STATEMENTS
from stickslip.extensions.paper.make import make
from stickslip.figures.page import number, save_text, symbols, with_unit
from stickslip.foundation.atomic_write import write_atomically
from tests.html_page import Page, check_alone, check_form, check_links


def test_every_file_is_there_and_nothing_else(folder: Path) -> None:
    expected = {f"figure{n}.{kind}" for n in range(1, 10) for kind in ("png", "svg", "nc")}
    expected |= {f"{name}.csv" for name in ("cases", "events", "shocks", "claims", "constants", "planar")} | {"report.html"}
    assert {path.name for path in folder.iterdir()} == expected


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("number", range(1, 10))
def test_data_reopen_with_units(number: int, folder: Path) -> None:
    dataset = xr.load_dataset(folder / f"figure{number}.nc", engine="h5netcdf")
    assert dataset.attrs["source"].startswith("stickslip ")
    assert dataset.attrs["Conventions"].startswith("CF-")
    numeric = [v for v in dataset.variables.values() if v.dtype.kind == "f"]
    assert numeric
    assert all("units" in v.attrs for v in numeric)


def test_svg_has_no_date(folder: Path) -> None:
    assert "dc:date" not in (folder / "figure5.svg").read_text(encoding="utf-8")


def test_tables_reopen(folder: Path) -> None:
    claims = pd.read_csv(folder / "claims.csv")
    assert set(claims.number) == set(range(1, 24))
    shocks = pd.read_csv(folder / "shocks.csv")
    assert set(shocks.columns) >= {"case", "time [s]", "cause", "rate_before [m/s]", "rate_after [m/s]"}
    events = pd.read_csv(folder / "events.csv")
    assert "start [s]" in events.columns


@pytest.mark.slow
def test_a_second_run_writes_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    make(tmp_path)
    for path in folder.iterdir():
        assert (tmp_path / path.name).read_bytes() == path.read_bytes(), path.name


def test_a_file_is_whole_or_not_there(tmp_path: Path) -> None:
    path = save_text(tmp_path / "table.csv", "old")

    def fail(partial: Path) -> None:
        partial.write_text("half")
        raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        write_atomically(path, fail)
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["table.csv"]


def test_importing_the_package_imports_no_plotting() -> None:
    code = "import sys, stickslip, stickslip.extensions.paper; print('matplotlib' in sys.modules, 'jinja2' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "False"]


@pytest.fixture(scope="module")
def page(folder: Path) -> Page:
    return Page((folder / "report.html").read_text(encoding="utf-8"))


def test_the_page_has_the_form_of_a_report(page: Page) -> None:
    check_form(page)
    assert sum("id" in attributes for _, attributes, _ in page.elements) > 9 + 20


def test_the_table_of_verdicts_comes_first_then_figures_then_claims(page: Page) -> None:
    contents, verdicts = page.place("nav"), page.place("table", **{"class": "verdicts"})
    picture, claim = page.place("img"), page.place("details")
    assert contents < verdicts < picture < claim
    assert verdicts == page.place("table")
    last = max(i for i, (tag, _, _) in enumerate(page.elements) if tag == "img")
    assert last < claim


def test_every_claim_is_in_the_table_and_folded_behind_its_verdict(page: Page) -> None:
    unfolded = page.having("details")
    assert len(unfolded) == len(STATEMENTS)
    assert not any("open" in attributes for attributes in unfolded)
    assert [tag for tag, _, around in page.elements if around[-1:] == ("details",)] == ["summary", "div"] * len(STATEMENTS)
    table, claims = page.within("tbody"), page.within("summary")
    for n, claim in STATEMENTS.items():
        assert claim in table
        assert f"{n}. {claim}" in claims
        place = page.place("div", id=f"claim-{n}")
        assert page.elements[place][2][-1] == "details"


def test_links_lead_to_places_on_the_page_or_to_files_beside_it(page: Page, folder: Path) -> None:
    inside = {link[1:] for link in check_links(page, folder) if link.startswith("#")}
    assert inside >= {"verdicts", "figures", "claims", "planar", "constants", "cases"} | {f"claim-{n}" for n in STATEMENTS}


def test_the_report_needs_nothing_from_elsewhere(page: Page, folder: Path) -> None:
    check_alone(page, (folder / "report.html").read_text(encoding="utf-8"))


def test_pictures_are_described_and_are_those_of_the_folder(page: Page, folder: Path) -> None:
    pictures = page.having("img")
    for n, attributes in enumerate(pictures, 1):
        assert len(attributes["alt"]) > 60
        code = attributes["src"].partition("base64,")[2]
        assert b64decode(code) == (folder / f"figure{n}.svg").read_bytes()
    assert len(pictures) == 9


def test_visible_numbers_have_meaningful_digits(page: Page, folder: Path) -> None:
    text = " ".join(text for _, text in page.text)
    assert not re.search(r"\b(None|nan|inf)\b", text)
    for found in re.findall(r"\d[\d.]*", text):
        assert len(found.replace(".", "").strip("0")) <= 8, found
    assert not re.search(r"(?<![\w-])[\d.]+e[+-]\d", text)
    digits = re.findall(r"\d\.\d{12,}", (folder / "claims.csv").read_text(encoding="utf-8"))
    assert len(digits) > 20, "the table keeps all digits"


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (1.0 / 3.0, "", "0.333333"),
        (0.0, "m/s", "0 m/s"),
        (-2.9914e-12, "m/s", "−2.9914 × 10⁻¹² m/s"),
        (9.8e6, "Pa s/m", "9.8 MPa s/m"),
        (2.5e5, "Pa", "250 kPa"),
        (3.2e12, "kg", "3.2 × 10¹² kg"),
        (999_999.4, "m", "999999 m"),
        (64471887.24235731, "Pa", "64.4719 MPa"),
        (3.43e10, "Pa", "34.3 GPa"),
        (624.998698, "Pa", "624.999 Pa"),
        (480.0 * 31_557_600.0, "s", "480 years"),
        (93_880.0, "s", "93880 s"),
        (0.02001218, "year", "7.30945 days"),
        (4.990767e-7, "year", "15.7497 s"),
        (50.0, "1/m", "50 /m"),
    ],
)
def test_numbers_are_given_in_readable_units(value: float, unit: str, expected: str) -> None:
    assert with_unit(value, unit) == expected


def test_what_is_no_number_is_no_number_for_readers_either() -> None:
    assert (number(float("nan")), number(float("-inf")), with_unit(None, "m")) == ("–", "−∞", "–")


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("S (μS − μD) < K", "S (μ<sub>S</sub> − μ<sub>D</sub>) &lt; K"),
        ("u0 = uc + 1, αc/2, such a duct", "u<sub>0</sub> = u<sub>c</sub> + 1, α<sub>c</sub>/2, such a duct"),
        ("(β − μ0S)", "(β − μ<sub>0</sub>S)"),
        ("fig5-slab-u0-1e-2", "fig5-slab-u0-1e-2"),
        ("mass × 1e-06 on 1e+06 kg/m²", "mass × 10⁻⁶ on 10⁶ kg/m²"),
    ],
)
def test_indices_are_subscripts_and_powers_of_ten_are_written_out(text: str, expected: str) -> None:
    assert str(symbols(text)) == expected
