"""The page of a fault in 2D in a real browser: no warnings, the clock moves all panels, and it fits a phone."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import expect

from tests.extensions.explorer.browser.harness import Watched, serve

SMALL = ("planar-patch", "--set", "contact.nodes=32", "--set", "run.duration=2 s")


@pytest.mark.slow
def test_the_page_of_a_fault_answers_moves_pins_and_fits_a_phone(
    tmp_path: Path, chromium: Any, visit: Callable[..., Watched]
) -> None:
    """Console warnings fail any visit; the profile at the end of the run is not that at its start."""
    served = serve(*SMALL, folder=tmp_path)
    try:
        page = visit(served.url, served.origin, (390, 844))
        page.page.locator(".sentence").filter(has_text="of the contact slips").wait_for()
        page.until("model('source:profile')?.data.slip.length === 32")
        assert page.page.evaluate("document.documentElement.scrollWidth") == 390
        page.until("Math.max(...model('source:profile').data.slip) === 0")
        page.page.locator("input.time").press("End")
        page.until("Math.max(...model('source:profile').data.slip) > 0")
        page.page.get_by_role("button", name="Pin").click()
        page.until("model('source:pinned').data.time.length > 0")
        page.page.locator("details.side > summary").click()
        field = page.page.locator("#control-contact-patches-0--initial-load")
        expect(field).to_have_value("71")
        field.fill("75")
        field.press("Enter")
        expect(page.page.locator(".pinned")).to_contain_text("contact.patches[0].initial.load: 7.1e+07 → 75.0 MPa")
        field.fill("nan")
        field.press("Enter")
        expect(page.page.locator("#control-contact-patches-0--initial-load-fault")).not_to_be_empty()
        page.page.close()
    finally:
        assert served.end() == 0
