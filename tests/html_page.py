"""A page as HTML, read for tests: its elements, its visible text, and what every page of a report must hold to."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

EMPTY = {"meta", "img"}
"""Elements without an end tag."""
PHRASES = {"p", "h1", "h2", "h3", "summary", "span", "a", "b", "sub", "caption", "code"}
BLOCKS = {"p", "h1", "h2", "table", "div", "section", "figure", "details", "ul", "li", "nav", "main", "header", "footer"}


class Page(HTMLParser):
    """The elements of a page in their order, each with its attributes and the elements around it, and its visible text."""

    def __init__(self, source: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.elements: list[tuple[str, dict[str, str], tuple[str, ...]]] = []
        self.text: list[tuple[tuple[str, ...], str]] = []
        self.feed(source)
        self.close()
        assert not self.open

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        assert len(attrs) == len(dict(attrs)), f"an attribute of {tag} is given twice"
        self.elements.append((tag, {name: value or "" for name, value in attrs}, tuple(self.open)))
        if tag not in EMPTY:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if not {"style", "title"} & set(self.open):
            self.text.append((tuple(self.open), data))

    def having(self, tag: str) -> list[dict[str, str]]:
        return [attributes for name, attributes, _ in self.elements if name == tag]

    def place(self, tag: str, **wanted: str) -> int:
        """Return the place of the first element with this tag and these attributes."""
        return next(i for i, (name, found, _) in enumerate(self.elements) if name == tag and wanted.items() <= found.items())

    def within(self, tag: str) -> str:
        return "".join(text for around, text in self.text if tag in around)


def check_form(page: Page) -> None:
    """Check that elements are nested as they must be, ids are unique, and headings descend one level at a time."""
    for tag, _, around in page.elements:
        assert not (tag in BLOCKS and PHRASES & set(around)), (tag, around)
    ids = [attributes["id"] for _, attributes, _ in page.elements if "id" in attributes]
    assert len(set(ids)) == len(ids)
    levels = [int(tag[1]) for tag, _, _ in page.elements if re.fullmatch("h[1-6]", tag)]
    assert levels.count(1) == 1
    assert levels[0] == 1
    assert all(later - earlier <= 1 for earlier, later in pairwise(levels))


def check_alone(page: Page, source: str) -> None:
    """Check that the page needs nothing from elsewhere: neither the net nor scripts nor other files."""
    assert "://" not in source
    assert "url(" not in source
    assert not {"script", "link", "iframe", "object"} & {tag for tag, _, _ in page.elements}
    assert all(attributes["src"].startswith("data:image/svg+xml;base64,") for attributes in page.having("img"))


def check_links(page: Page, folder: Path) -> list[str]:
    """Check that links lead to places on the page or to files beside it, and return the links."""
    ids = {attributes["id"] for _, attributes, _ in page.elements if "id" in attributes}
    links = [attributes["href"] for attributes in page.having("a")]
    assert {link[1:] for link in links if link.startswith("#")} <= ids
    beside = [link for link in links if not link.startswith("#")]
    assert beside
    assert all((folder / link).is_file() for link in beside)
    return links
