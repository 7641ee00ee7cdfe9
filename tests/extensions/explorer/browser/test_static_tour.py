"""The tour as plain files, opened from the disk: each step is shown, slider and cursor work, and nothing else is asked for."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import expect

from stickslip.extensions.explorer.model.tour import TOUR
from stickslip.extensions.explorer.static.export import write_tour
from tests.extensions.explorer.browser.harness import Watched


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, chromium: Any) -> Path:
    return write_tour(tmp_path_factory.mktemp("static") / "tour", places=2).folder


def test_the_tour_works_from_the_disk(folder: Path, visit: Callable[..., Watched]) -> None:
    watched = visit((folder / "index.html").as_uri(), "file://")
    page = watched.page
    for k, step in enumerate(TOUR, 1):
        page.locator("h2", has_text=f"{k} of 8: {step.title}").wait_for()
        watched.until(f"location.hash === '#step-{k}'")
        watched.until_near("model('cursor:slip').location", step.cursor, within=1e-6)
        expect(page.locator(".knob label")).to_have_text(step.strip.parameter)
        page.get_by_role("button", name="Next step").click() if k < len(TOUR) else None
    page.get_by_role("button", name="Step 6: The jump").click()
    page.locator(".sentence", has_text="up to 4.102 m/s").wait_for()
    expect(page.locator(".knob output")).to_have_text("100 MPa")
    slider = page.locator("#place")
    slider.press("End")
    page.locator(".sentence", has_text="up to 9.204 m/s").wait_for()
    expect(page.locator(".knob output")).to_have_text("200 MPa")
    watched.until_near("model('here:strip_slip').location", 200, within=1e-9)
    watched.until_near("Math.max(...model('source:motion').get_column('rate'))", 9.204, within=1e-3)
    page.get_by_role("button", name="Play", exact=True).click()
    watched.until(f"model('cursor:slip').location > {TOUR[5].cursor} + 0.1")
    page.get_by_role("button", name="Pause").click()


def test_a_step_has_an_address_and_a_missing_file_is_told(folder: Path, visit: Callable[..., Watched]) -> None:
    watched = visit(f"{(folder / 'index.html').as_uri()}#step-8", "file://")
    watched.page.locator("h2", has_text="8 of 8: Hysteresis").wait_for()
    hidden = (folder / "data" / "step-2.js").rename(folder / "data" / "away.js")
    watched.page.get_by_role("button", name="Step 2: A law of slip").click()
    watched.page.locator(".fault", has_text="data/step-2.js is missing from this folder").wait_for()
    hidden.rename(folder / "data" / "step-2.js")
    assert all("ERR_FILE_NOT_FOUND" in fault for fault in watched.faults)
    watched.faults.clear()
