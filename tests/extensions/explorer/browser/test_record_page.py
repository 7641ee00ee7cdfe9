"""A record behind the runs, in a real browser: `stickslip explore SCENARIO --record FILE`."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import expect

import stickslip as ss
from tests.extensions.explorer.browser.harness import Watched, serve


@pytest.mark.slow
def test_a_slider_changes_the_misfit_that_the_page_shows(tmp_path: Path, chromium: Any, visit: Callable[..., Watched]) -> None:
    time = np.linspace(0.0, 6.0, 200)
    shear = ss.simulate("fig6-block-reconstructed").traction(time)
    rows = "\n".join(f"{t},{force}" for t, force in zip(time, shear, strict=True))
    (tmp_path / "a.csv").write_text(f"time (s),shear force (N)\n{rows}\n")
    served = serve("fig6-block-reconstructed", "--record", "a.csv", folder=tmp_path)
    try:
        page = visit(served.url, served.origin)
        sentence = page.page.locator(".sentence").filter(has_text="It differs from a.csv by shear force")
        sentence.wait_for()
        page.until("model('source:measured').data.time.length === 200")
        legend = page.page.locator("[data-heading=traction]").filter(has_text="measured, misfit")
        expect(legend).to_contain_text("misfit 0 N")
        field = page.page.locator("#control-friction-alpha")
        field.fill("1.2")
        field.press("Enter")
        expect(legend).not_to_contain_text("misfit 0 N")
        found = re.search(r"misfit ([\d.e+]+) \w?N", legend.inner_text())
        assert found is not None, legend.inner_text()
        assert float(found[1]) > 0.0
        page.page.close()
    finally:
        assert served.end() == 0
