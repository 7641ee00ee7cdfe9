"""Open every page of a built site in a browser, from the file system, as a reader without internet does.

It needs the extra `test` and a browser (`tests/extensions/explorer/install_browser.sh`), and takes half a minute:

python docs/site/browse_site.py docs/_build/html

Each page is opened in the dark on a narrow screen. Faults are what the browser says is wrong, requests that leave the folder,
pictures that are missing or without a text that stands for them, pages wider than the screen, and a search that finds nothing.
"""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from playwright.sync_api import sync_playwright

WIDTH = 390
"""Width (px) of the narrow screen."""
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
"""Path of the browser; None means the one that playwright has brought."""
LOOK = """() => ({
  width: document.documentElement.scrollWidth,
  pictures: [...document.images].filter((one) => !one.alt || !one.naturalWidth).map((one) => one.src),
  links: [...document.links].map((one) => one.href.split(/[#?]/)[0]),
})"""


def faults_of(page: Any, address: str, heard: list[str], todo: list[str]) -> Iterator[str]:
    """Open a page, yield what is wrong with it, and add the pages that it links to."""
    page.goto(address)
    page.wait_for_timeout(100)
    found = page.evaluate(LOOK)
    if found["width"] > WIDTH:
        yield f"{found['width']} px wide"
    yield from (f"no picture, or no text for it: {one}" for one in found["pictures"])
    yield from heard
    heard.clear()
    todo += found["links"]


def main(folder: Path) -> int:
    """Print what is wrong, and one line on all of it; return the exit code."""
    root, heard, seen, wrong = folder.resolve().as_uri(), [], set(), []
    todo = [f"{root}/index.html"]
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": WIDTH, "height": 844}, color_scheme="dark")
        page.on("console", lambda said: heard.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: heard.append(str(error)))
        page.on("request", lambda asked: None if asked.url.startswith((root, "data:")) else heard.append(f"asks for {asked.url}"))
        while todo:
            address = todo.pop()
            if address in seen or not address.startswith(root) or not address.endswith(".html"):
                continue
            seen.add(address)
            wrong += [f"{address.removeprefix(root)}: {fault}" for fault in faults_of(page, address, heard, todo)]
        page.goto(f"{root}/search.html?q=impedance")
        page.wait_for_timeout(2000)
        if not page.locator("#search-results li").count():
            wrong.append("the search finds nothing")
        browser.close()
    print(*wrong, f"{len(seen)} pages, {len(wrong)} faults", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
