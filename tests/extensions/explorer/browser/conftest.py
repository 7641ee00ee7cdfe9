"""One browser for the tests of this folder, one server for most of them, and pages that fail when they do something wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest

from tests.extensions.explorer.browser.harness import NO_BROWSER, PATIENCE, Served, Watched, launch, serve


@pytest.fixture(scope="package")
def chromium() -> Iterator[Any]:
    """The browser; tests are skipped, with a sentence that says why, where there is none.

    It ends with the tests of this folder, because an event loop runs in the main thread as long as it is open: no other test could
    start its own.
    """
    sync_api = pytest.importorskip("playwright.sync_api")
    sync_api.expect.set_options(timeout=PATIENCE)
    with sync_api.sync_playwright() as playwright:
        browser = launch(playwright)
        if browser is None:
            pytest.skip(NO_BROWSER)
        yield browser
        browser.close()


@pytest.fixture(scope="package")
def server(tmp_path_factory: pytest.TempPathFactory, chromium: Any) -> Iterator[Served]:
    """A server of the explorer, which Ctrl-C stops in the end."""
    served = serve("--sessions", "20", folder=tmp_path_factory.mktemp("served"))
    yield served
    assert served.end() == 0


@pytest.fixture
def visit(chromium: Any) -> Iterator[Callable[..., Watched]]:
    """A function that opens a page in a window of its own, and closes it; what the page did wrong fails the test."""
    opened: list[Watched] = []

    def open_page(url: str, origin: str, size: tuple[int, int] = (1280, 800), **context: Any) -> Watched:
        window = chromium.new_context(
            viewport={"width": size[0], "height": size[1]}, accept_downloads=True, **{"reduced_motion": "reduce"} | context
        )
        watched = Watched(window.new_page(), origin)
        opened.append(watched)
        watched.page.goto(url)
        return watched

    yield open_page
    for watched in opened:
        watched.page.context.close()
    assert [fault for watched in opened for fault in watched.faults] == []
