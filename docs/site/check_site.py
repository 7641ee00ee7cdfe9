"""Check a built site: every link within it has its target, and no page loads anything from another host.

`make site` runs it. Links to other hosts cannot be followed where there is no internet: they are counted and listed, not followed.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

LOADS = {"img": ("src", "srcset"), "script": ("src",), "source": ("src", "srcset"), "iframe": ("src",), "video": ("src", "poster")}
"""Attributes by which a page loads something; `link` does so too, for these relations:"""
LOADED_LINKS = {"stylesheet", "icon", "preload", "prefetch", "preconnect", "dns-prefetch", "manifest", "modulepreload"}


class Page(HTMLParser):
    """The anchors of a page, what it links to and what it loads."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.loads: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        """Note what a tag refers to."""
        values = {name: value for name, value in attributes if value}
        self.anchors |= {values[name] for name in ("id", "name") if name in values}
        if tag == "a" and "href" in values:
            self.links.append(values["href"])
        if tag == "link" and LOADED_LINKS & set(values.get("rel", "").split()):
            self.loads.append(values.get("href", ""))
        for name in LOADS.get(tag, ()):
            if name in values:
                self.loads += [part.split()[0] for part in values[name].split(",")] if name == "srcset" else [values[name]]


def is_elsewhere(target: str) -> bool:
    """Return True if a target is on another host; data within the page is not."""
    return bool(urlsplit(target).netloc)


def faults(folder: Path, pages: dict[Path, Page]) -> Iterator[str]:
    """Yield one line for each target that is missing and each asset of another host."""
    for path, page in pages.items():
        where = path.relative_to(folder)
        for target in page.links + page.loads:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc:
                if target in page.loads and is_elsewhere(target):
                    yield f"{where}: loads {target} from another host"
                continue
            aim = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not aim.is_file():
                yield f"{where}: {target} is missing"
            elif parts.fragment and aim in pages and unquote(parts.fragment) not in pages[aim].anchors:
                yield f"{where}: {target} has no such anchor"


def styles(folder: Path) -> Iterator[str]:
    """Yield one line for each style sheet that loads something from another host."""
    for path in folder.rglob("*.css"):
        text = path.read_text(encoding="utf-8").replace(" ", "")
        if any(
            f"{start}{quote}{host}" in text for start in ("url(", "@import") for quote in ("", '"', "'") for host in ("http", "//")
        ):
            yield f"{path.relative_to(folder)}: loads something from another host"


def main(folder: Path) -> int:
    """Print what is wrong, or one line that nothing is; return the exit code."""
    paths = [path for path in sorted(folder.rglob("*.html")) if "_static" not in path.parts]  # templates of the theme lie there
    pages = {path.resolve(): Page(path) for path in paths}
    wrong = [*faults(folder.resolve(), pages), *styles(folder)]
    outside = sorted({link for page in pages.values() for link in page.links if is_elsewhere(link)})
    inside = sum(len(page.links) for page in pages.values()) - sum(
        is_elsewhere(link) for page in pages.values() for link in page.links
    )
    print(*wrong, sep="\n", end="\n" if wrong else "")
    print(f"{len(pages)} pages, {inside} links within the site, {len(wrong)} faults")
    print(f"{len(outside)} links to other hosts, which are not followed:", *outside, sep="\n  ")
    return 1 if wrong or not pages else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
