"""The explorer in a real browser. Most tests share one page, which is brought back to the paper's slab before each."""

from __future__ import annotations

import re
from collections.abc import Iterator
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from playwright.sync_api import expect

from stickslip.extensions.explorer.model.tour import TOUR
from stickslip.problem.scenarios import read_scenario
from tests.extensions.explorer.browser.harness import PATIENCE, Served, Watched
from tests.limits import examples

PANELS = {"law", "contact", "shape", "slip", "rate", "traction", "field", "energy"}
SIZES = {"laptop": (1280, 800), "projector": (1920, 1080), "phone": (390, 844)}
MODEL = "(name) => Bokeh.documents[0].get_model_by_name(name)"


class Shown:
    """What a user of the page sees and does."""

    def __init__(self, watched: Watched) -> None:
        self.watched, self.page, self.until, self.until_near = watched, watched.page, watched.until, watched.until_near

    def said(self, part: str) -> Any:
        """Wait until the sentence holds some words; return the whole sentence."""
        found = self.page.locator(".sentence").filter(has_text=part)
        found.wait_for()
        return found.inner_text()

    def enter(self, control: str, value: str) -> None:
        """Type a value into a field."""
        field = self.page.locator(f"#control-{control}")
        field.fill(value)
        field.press("Enter")

    def open(self, name: str, content: str) -> None:
        """Open a file on the page."""
        file = {"name": name, "mimeType": "text/plain", "buffer": content.encode()}
        self.page.locator(".tools input[type=file]").set_input_files(file)

    def save(self, kind: str) -> bytes:
        """Save a file of the page, and return its content."""
        self.page.locator("summary", has_text="Save").click()
        with self.page.expect_download() as found:
            self.page.locator(f"[data-kind={kind}]").click()
        return Path(found.value.path()).read_bytes()

    def model(self, name: str, part: str) -> Any:
        """An attribute of a model of Bokeh."""
        return self.page.evaluate(f"(name) => ({MODEL})(name).{part}", name)

    def cursor(self) -> float:
        """Where the cursor is, which must be the same in each panel with an axis of time."""
        (found,) = {self.model(f"cursor:{name}", "location") for name in ("slip", "rate", "traction", "field", "energy")}
        return float(found)

    def begin(self) -> None:
        """Bring the page back to the slab of Fig. 6, without tour, strip, pin or fault."""
        for name in ("Close the tour", "Unpin"):
            button = self.page.get_by_role("button", name=name)
            if button.is_visible():
                button.click()
        self.page.locator("select.parameter").select_option("")
        for scenario, words in (("fig7-slab-critical", "140.8 µm/s"), ("fig6-slab", "is 5.102 times")):
            self.page.locator("#control-scenario").select_option(scenario)
            self.said(words)


def begun(watched: Watched) -> Shown:
    """A page whose first answer is there."""
    shown = Shown(watched)
    watched.page.locator(".sentence").filter(has_text="slip event").wait_for(timeout=PATIENCE)
    return shown


@pytest.fixture(scope="module")
def opened(chromium: Any, server: Served) -> Iterator[Shown]:
    """The page that most tests share."""
    window = chromium.new_context(
        viewport={"width": 1280, "height": 800}, accept_downloads=True, color_scheme="light", reduced_motion="reduce"
    )
    watched = Watched(window.new_page(), server.origin)
    watched.page.goto(server.url)
    yield begun(watched)
    window.close()


@pytest.fixture
def shown(opened: Shown) -> Iterator[Shown]:
    """The shared page at its beginning; what it did wrong fails the test."""
    opened.watched.faults.clear()
    opened.begin()
    yield opened
    assert opened.watched.faults == []


@pytest.mark.slow
def test_nothing_plays_by_itself_where_less_motion_is_preferred(opened: Shown) -> None:
    """Before the page is touched by any other test."""
    opened.page.wait_for_timeout(100)
    assert opened.model("cursor:slip", "location") == 0.0
    assert opened.page.get_by_role("button", name="Play", exact=True).is_visible()


def test_a_page_opens_with_the_papers_slab_and_all_its_panels(shown: Shown) -> None:
    assert shown.said("Irregular").startswith("Irregular: several slip rates at some loads; alpha = 1 s/m is 5.102 times")
    for panel in PANELS:
        shown.page.locator(f"[data-panel={panel}]").wait_for()
    panels = shown.page.locator("[data-panel]:visible").evaluate_all("(all) => all.map((one) => one.dataset.panel)")
    assert set(panels) == PANELS
    shown.until_near("model('source:motion').get_column('rate')[1]", 4.102, within=1e-3)


def test_a_field_and_a_slider_change_the_regime(shown: Shown) -> None:
    shown.enter("friction-alpha", "0.1959")
    assert shown.said("alpha = 0.1959 s/m").startswith("Regular")
    slider = shown.page.locator("#control-friction-alpha-slider")
    slider.focus()
    for _ in range(5):
        slider.press("PageUp")
    assert shown.said("Irregular").startswith("Irregular")


def test_one_cursor_moves_through_all_panels_by_slider_key_click_and_mark(shown: Shown) -> None:
    page = shown.page
    page.locator("[data-plots]").focus()
    page.keyboard.press("Home")
    page.keyboard.press("Shift+ArrowRight")
    shown.until("model('cursor:slip').location > 0")
    assert shown.cursor() == pytest.approx(0.05 * 12)
    page.locator("input.time").evaluate("(one) => { one.value = 250; one.dispatchEvent(new Event('input')); }")
    shown.until("model('cursor:slip').location === 3")
    assert shown.cursor() == 3.0
    shown.until_near("model('source:now').get_column('slip')[0]", 3.0 * 4.10204, within=1e-3)
    page.locator(".marks button.arrest").click()
    shown.until_near("model('cursor:energy').location", 5.7142857, within=1e-5)
    page.locator(".clock", has_text="5.71").wait_for()


@pytest.mark.slow
def test_playing_moves_the_cursor_until_it_is_paused(shown: Shown) -> None:
    page = shown.page
    page.locator(".bar > .start").click()
    page.locator("select[aria-label='Speed of playing']").select_option("4")
    page.get_by_role("button", name="Play", exact=True).click()
    shown.until("model('cursor:slip').location > 0.2")
    page.get_by_role("button", name="Pause").click()
    before = shown.cursor()
    page.wait_for_timeout(100)
    assert shown.cursor() == before


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("name", "legend", "colour"),
    [("stress", "±80.4 MPa", "blue"), ("displacement", "±23.4 m", "red"), ("velocity", "±4.1 m/s", "red")],
)
def test_the_slab_is_shown_by_velocity_displacement_or_stress(shown: Shown, name: str, legend: str, colour: str) -> None:
    """Behind the wave that leaves the contact particles move forwards (red), and the stress has fallen (blue)."""
    shown.page.locator("select[data-field]").select_option(name)
    expect(shown.page.locator("[data-heading=field] li").first).to_contain_text(legend)
    plot = shown.page.locator("[data-panel=field] .plot")
    for _ in range(PATIENCE // 100):
        picture = Image.open(BytesIO(plot.screenshot())).convert("RGB")
        red, _, blue = picture.getpixel((int(0.3 * picture.width), int(0.6 * picture.height)))
        if ("red" if red > blue + 30 else "blue" if blue > red + 30 else "neither") == colour:
            return
        shown.page.wait_for_timeout(100)
    raise AssertionError(f"the slab is not {colour} there: {red}, {blue}")


def test_a_strip_is_drawn_and_a_click_goes_to_its_run(shown: Shown) -> None:
    page = shown.page
    page.locator("select.parameter").select_option("friction.alpha")
    shown.until("model('source:strip')?.get_column('slip')?.length === 200")
    page.locator("input.low").fill("0.1")
    page.locator("input.low").press("Enter")
    shown.until_near("model('range:strip_x').start", -1, within=1e-9)
    place = page.evaluate(
        f"""() => {{
          const plot = ({MODEL})("plot:strip_slip");
          const found = [...Bokeh.index.roots].flatMap((root) => [root, ...root.children()]).find((view) => view.model === plot);
          const view = found ?? Bokeh.index.find_one(plot);
          view.el.scrollIntoView();
          const box = view.el.getBoundingClientRect(), frame = view.frame;
          return [box.left + frame.x_scale.compute(Math.log10(0.5)), box.top + frame.bbox.vcenter];
        }}"""
    )
    page.mouse.click(*place)
    sentence = shown.said("s/m is 2.5")
    value = float(re.findall(r"alpha = ([\d.]+)", sentence)[0])
    assert value == pytest.approx(0.5, rel=0.03)


def test_the_tour_walks_through_the_paper(shown: Shown) -> None:
    page = shown.page
    page.get_by_role("button", name="Tour", exact=True).click()
    walked = TOUR[: examples(12)]  # the tour from the disk goes through all of it
    for k, step in enumerate(walked, 1):
        page.locator("h2", has_text=f"{k} of 8: {step.title}").wait_for()
        expect(page.locator(".told")).to_have_text(step.text)
        page.locator(f"[data-look][data-panel={step.panel}]").wait_for()
        assert page.locator("[data-look]").count() == 1
        shown.until_near("model('cursor:slip').location", step.cursor, within=1e-6)
        shown.until(f"model('axis:strip_x@strip_slip').axis_label?.startsWith('{step.strip.parameter}')")
        page.get_by_role("button", name="Next step").click() if k < len(walked) else None
    page.get_by_role("button", name=f"Step 8: {TOUR[-1].title}").click()
    expect(page.get_by_role("button", name="Next step")).to_be_disabled()
    page.get_by_role("button", name="Close the tour").click()
    page.locator("section.step").wait_for(state="hidden")
    expect(page.locator("[data-look]")).to_have_count(0)


def test_what_is_saved_is_downloaded_whole(shown: Shown) -> None:
    shown.enter("friction-alpha", "0.7")
    shown.said("= 0.7 s/m")
    assert read_scenario(shown.save("toml").decode(), "saved").problem.parameters["alpha"].value == 0.7
    assert shown.save("png")[:8] == b"\x89PNG\r\n\x1a\n"


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("size", SIZES)
def test_nothing_runs_out_of_the_page_at_any_size(shown: Shown, size: str) -> None:
    width, height = SIZES[size]
    shown.page.get_by_role("button", name="Tour", exact=True).click()  # and its strip with it
    shown.until("model('axis:strip_x@strip_slip').axis_label?.startsWith('body.stiffness')")
    shown.page.set_viewport_size({"width": width, "height": height})
    shown.page.wait_for_timeout(200)  # the plots are drawn anew after the change of size
    try:
        shown.until(f"document.documentElement.scrollWidth <= {width}")
        for name in ("[data-panel=slip] .plot", "[data-panel=law] .plot", "[data-panel=energy] .plot", "section.step"):
            box = shown.page.locator(name).bounding_box()
            assert box["width"] > 200
            assert box["height"] > 40
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= width
        assert shown.page.get_by_role("button", name="Play", exact=True).is_visible()
        shown.until(
            """["pulses", "slip", "first_end", "peak_rate"]
            .map((name) => Bokeh.index.find_one(model(`plot:strip_${name}`)).el.getBoundingClientRect())
            .every((one, i, all) => all.slice(0, i).every((other) => other.right <= one.left + 1 || other.bottom <= one.top + 1))"""
        )  # no plot of the strip lies on another
    finally:
        shown.page.set_viewport_size({"width": 1280, "height": 800})


def test_the_ground_turns_dark_and_the_plots_with_it(shown: Shown) -> None:
    switch = shown.page.get_by_role("button", name="Dark ground")
    switch.click()
    expect(shown.page.locator("html")).to_have_attribute("data-ground", "dark")
    shown.until("model('axis:time@traction').axis_label_text_color === '#E8EAED'")
    switch.click()
    shown.until("model('axis:time@traction').axis_label_text_color !== '#E8EAED'")


def test_the_whole_page_can_be_reached_with_the_tab_key(shown: Shown) -> None:
    page = shown.page
    page.evaluate("document.activeElement?.blur()")
    reached = set()
    for _ in range(70):
        page.keyboard.press("Tab")
        reached.add(
            page.evaluate(
                """() => { let one = document.activeElement;
                   while (one?.shadowRoot?.activeElement) one = one.shadowRoot.activeElement;
                   return one?.id || one?.className || one?.textContent.trim(); }"""
            )
        )
    assert {"control-friction-alpha", "control-scenario", "play", "time", "panels", "parameter"} <= reached


def test_the_address_follows_the_page(shown: Shown) -> None:
    shown.enter("friction-alpha", "0.7")
    shown.said("= 0.7 s/m")
    shown.page.locator("select.parameter").select_option("friction.alpha")
    shown.page.locator(".marks button.arrest").click()
    shown.page.wait_for_function("() => location.search.includes('strip=') && location.search.includes('t=5.71')")
    assert "friction.alpha=0.7" in shown.page.url
