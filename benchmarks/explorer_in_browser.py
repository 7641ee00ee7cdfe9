"""What a moved slider costs in the server and in the browser together: the second table of `python -m benchmarks.explorer`.

A real page is opened in a headless chromium without a graphics card, and its slider is moved one step at a time, with a pause in
which everything comes to rest. Processor time is that of the server's process, of the page's main thread (scripts, styles, layout,
and drawing), and of all processes of the browser, which besides paint, composite, and take messages from the network.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from tests.extensions.explorer.browser.harness import launch, serve

CASES = (
    ("fig6-slab", "friction-alpha"),
    ("fig5-slab-reconstructed", "friction-wavenumber"),
    ("fig6-block-reconstructed", "friction-alpha"),
)
"""Scenario, and the control whose slider is moved."""
MOVES, REST_MS = 30, 600
"""Number of moves, and the pause (ms) after each: longer than the page waits until it brings its address up to date."""
FIND = """const find = (root) => root.querySelector(`#${id}`) ?? [...root.querySelectorAll("*")].reduce(
  (found, one) => found ?? (one.shadowRoot ? find(one.shadowRoot) : null), null);"""
PLACE = f"(id) => {{ {FIND} return Number(find(document).value); }}"
MOVE = f"""([id, place]) => new Promise((done) => {{
  {FIND}
  window.moved ??= find(document);
  const change = Bokeh.documents[0].get_model_by_name("source:motion").properties.data.change, begin = performance.now();
  const heard = () => {{ change.disconnect(heard); setTimeout(() => done(performance.now() - begin), 50); }};
  change.connect(heard);
  window.moved.value = place;
  window.moved.dispatchEvent(new Event("input"));
}})"""


class Spent(NamedTuple):
    """Processor time (ms) of one move."""

    server: float
    main_thread: float
    scripts: float
    browser: float


def spent_by_moves(moves: int = MOVES) -> dict[str, Spent]:
    """Return what a move takes in each case: the medians of the page's main thread, and means of whole processes."""
    from playwright.sync_api import sync_playwright

    found = {}
    with TemporaryDirectory() as folder, sync_playwright() as playwright:
        browser, served = launch(playwright), serve(folder=Path(folder))
        try:
            for name, control in CASES:
                page = browser.new_page(viewport={"width": 1280, "height": 800}, reduced_motion="reduce")
                page.set_default_timeout(300_000)
                page.goto(f"{served.url}&scenario={name}")
                page.locator(".sentence").filter(has_text="slip event").wait_for()
                page.wait_for_timeout(5_000)
                found[name] = _of_case(browser, page, f"control-{control}-slider", served.process.pid, moves)
                page.close()
        finally:
            served.end()
            browser.close()
    return found


def _of_case(browser: Any, page: Any, slider: str, server: int, moves: int) -> Spent:
    whole, own = browser.new_browser_cdp_session(), page.context.new_cdp_session(page)
    own.send("Performance.enable", {"timeDomain": "threadTicks"})
    place = page.evaluate(PLACE, slider)
    page.evaluate(MOVE, [slider, place + 1])
    page.wait_for_timeout(REST_MS)
    start, tasks, scripts = (_of_browser(whole), _of_process(server)), [], []
    for k in range(moves):
        before = _of_page(own)
        page.evaluate(MOVE, [slider, place + 2 * k + 3])
        page.wait_for_timeout(REST_MS)
        after = _of_page(own)
        tasks.append(after["TaskDuration"] - before["TaskDuration"])
        scripts.append(after["ScriptDuration"] - before["ScriptDuration"])
    in_browser, in_server = _of_browser(whole) - start[0], _of_process(server) - start[1]
    return Spent(in_server / moves, median(tasks), median(scripts), in_browser / moves)


def _of_page(session: Any) -> dict[str, float]:
    """Return the processor times (ms) of the page's main thread since it was opened."""
    return {one["name"]: 1e3 * one["value"] for one in session.send("Performance.getMetrics")["metrics"]}


def _of_browser(session: Any) -> float:
    """Return the processor time (ms) of all processes of the browser."""
    return 1e3 * float(sum(one["cpuTime"] for one in session.send("SystemInfo.getProcessInfo")["processInfo"]))


def _of_process(number: int) -> float:
    """Return the processor time (ms) of a process, as Linux counts it: in steps of 10 ms."""
    fields = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()
    return 1e3 * (int(fields[11]) + int(fields[12])) / float(os.sysconf("SC_CLK_TCK"))


def print_table(out: Callable[[str], Any]) -> None:
    """Print the table of benchmarks/README.md."""
    out("| scenario | server | main thread of the page | of it scripts | all of the browser | server and main thread |\n")
    out(f"|{' --- |' * 6}\n")
    for name, (server, task, scripts, browser) in spent_by_moves().items():
        cells = (f"{one:.0f} ms" for one in (server, task, scripts, browser, server + task))
        out(f"| {name} | {' | '.join(cells)} |\n")
