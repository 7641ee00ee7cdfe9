"""Where things stand on the page, in a real browser."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Any

import pytest

from tests.extensions.explorer.browser.harness import PATIENCE, Served, Watched

SIZES = ((1024, 768), (1280, 800))
TOOLS = """(names) => names.map((name) => {
  const walk = (node) => [node, ...(node.shadowRoot ? walk(node.shadowRoot) : []), ...[...node.children].flatMap(walk)];
  const one = walk(document.querySelector(".top")).find((found) => ["BUTTON", "SUMMARY"].includes(found.tagName)
    && (found.getAttribute("aria-label") ?? found.textContent.trim()) === name);
  const text = document.createRange();
  text.selectNodeContents(one);
  const box = one.getBoundingClientRect();
  return { left: box.left, right: box.right, top: box.top, bottom: box.bottom, line: text.getBoundingClientRect().bottom };
})"""
"""The boxes of buttons in the bar, by their names, and where their texts end below."""

CURSOR = "window.Bokeh?.documents?.[0]?.get_model_by_name('cursor:slip')?.location"
"""Where the cursor is, also before the page has its plots."""


@pytest.fixture(scope="module")
def page(chromium: Any, server: Served) -> Iterator[Any]:
    """A page with the slab of Fig. 6, whose sentence is among the longest, at the address of one of its moments."""
    window = chromium.new_context(viewport={"width": 1280, "height": 800}, reduced_motion="no-preference")
    watched = Watched(window.new_page(), server.origin)
    watched.page.goto(f"{server.url}&t=3")
    watched.page.locator(".sentence").filter(has_text="slip event").wait_for(timeout=PATIENCE)
    yield watched.page
    window.close()
    assert watched.faults == []


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(("width", "height"), SIZES)
@pytest.mark.parametrize("large", [False, True])
def test_the_sentence_is_shown_whole(page: Any, width: int, height: int, large: bool) -> None:
    page.set_viewport_size({"width": width, "height": height})
    sentence = page.locator(".sentence")
    sentence.evaluate("(one, size) => { one.style.fontSize = size; }", "1.2rem" if large else "")
    seen, whole = sentence.evaluate("(one) => [one.clientHeight, one.scrollHeight]")
    below, panels = page.locator(".below").first.bounding_box(), page.locator(".middle").bounding_box()
    strip, main = page.locator("main > .strip").bounding_box(), page.locator("main").bounding_box()
    sentence.evaluate("(one) => { one.style.fontSize = ''; }")
    assert whole <= seen
    assert large or strip["y"] + strip["height"] <= main["y"] + main["height"] + 1  # the bar of the strip is in sight, too
    assert below["y"] + below["height"] <= panels["y"] + 1


@pytest.mark.slow
def test_sentences_have_the_font_of_the_page(page: Any) -> None:
    first = "(one) => getComputedStyle(one).fontFamily.split(',')[0]"
    assert page.locator(".sentence").evaluate(first) == page.locator("body").evaluate(first)


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("width", "height"), SIZES)
def test_buttons_of_the_bar_have_one_height_one_baseline_and_room_between_them(page: Any, width: int, height: int) -> None:
    page.set_viewport_size({"width": width, "height": height})
    boxes = page.evaluate(TOOLS, ["Tour", "Pin", "Open", "Save", "Copy link"])
    for side in ("top", "bottom", "line"):
        assert max(box[side] for box in boxes) - min(box[side] for box in boxes) < 1.0, side
    gaps = [right["left"] - left["right"] for left, right in pairwise(boxes)]
    assert min(gaps) >= 4.0
    assert max(gaps) - min(gaps) < 1.0
    (switch,) = page.evaluate(TOOLS, ["Dark ground"])
    assert switch["bottom"] - switch["top"] == pytest.approx(boxes[0]["bottom"] - boxes[0]["top"], abs=1.0)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("width", "height"), SIZES)
def test_first_words_in_the_bar_say_what_is_seen_and_what_to_move(page: Any, width: int, height: int) -> None:
    page.set_viewport_size({"width": width, "height": height})
    words, bar = page.locator(".first-words"), page.locator(".top").bounding_box()
    assert "First move a slider" in words.inner_text()
    box, title, tour = (
        words.bounding_box(),
        page.locator("h1").bounding_box(),
        page.get_by_role("button", name="Tour").bounding_box(),
    )
    assert title["x"] + title["width"] < box["x"] < box["x"] + box["width"] < tour["x"]
    assert bar["y"] <= box["y"] < box["y"] + box["height"] <= bar["y"] + bar["height"] <= 44.0


def test_the_first_run_plays_once_until_something_is_touched(visit: Callable[..., Watched], server: Served) -> None:
    watched = visit(server.url, server.origin, reduced_motion="no-preference")
    watched.page.wait_for_function(f"() => {CURSOR} > 0")
    watched.page.keyboard.press("Shift")
    watched.until("model('cursor:slip').location === 0")
    watched.page.get_by_role("button", name="Play", exact=True).wait_for()


def test_nothing_plays_by_itself_where_a_link_names_a_time(page: Any) -> None:
    page.wait_for_function(f"() => {CURSOR} === 3")
    page.wait_for_timeout(100)
    assert page.evaluate(CURSOR) == 3.0
    assert page.get_by_role("button", name="Play", exact=True).is_visible()
