"""Work beside a page: the latest request counts, a stop and a closed page end it, and no error ends the page."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import pytest

from stickslip.extensions.explorer.model import solve as solving
from stickslip.extensions.explorer.model.solve import Stopped, solve
from stickslip.extensions.explorer.server import desk as desks
from stickslip.extensions.explorer.server.desk import ThreadDesk
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import load_scenario

LONG = 20.0
"""Time (s) after which a test gives up waiting."""


class Page:
    """A page in the thread of the test: it notes what it is given, and does what its desk has delivered when `turn` is called."""

    def __init__(self) -> None:
        self.calls: queue.Queue[Callable[[], None]] = queue.Queue()
        self.desk = ThreadDesk(self.calls.put)
        self.news: list[str] = []
        self.results: list[Any] = []
        self.faults: list[str] = []
        self.desk.report = self.news.append

    def ask(self, work: Callable[..., Any]) -> None:
        """Ask for work."""
        self.desk.ask(work, self.results.append, lambda error: self.faults.append(str(error)))

    def turn(self) -> None:
        """Do the next thing that the desk has delivered."""
        self.calls.get(timeout=LONG)()

    def until(self, reached: Callable[[], bool]) -> None:
        """Do what the desk delivers until something is reached."""
        while not reached():
            self.turn()


@pytest.fixture
def page(monkeypatch: pytest.MonkeyPatch) -> Iterator[Page]:
    monkeypatch.setattr(desks, "QUIET", 0.0)
    made = Page()
    yield made
    made.desk.close()


class Held:
    """Work that tells its progress until it is let go; it notes how it ended."""

    def __init__(self, result: str = "held") -> None:
        self.begun, self.ended, self.go = threading.Event(), threading.Event(), threading.Event()
        self.result, self.end = result, ""

    def __call__(self, told: Callable[[str], None]) -> str:
        self.begun.set()
        try:
            while not self.go.wait(0.005):
                told("at it")
        except Stopped:
            self.end = "stopped"
            return f"{self.result} so far"
        except BaseException as error:
            self.end = type(error).__name__
            raise
        finally:
            self.ended.set()
        return self.result


def test_work_is_done_in_another_thread_and_its_result_shown_on_the_page(page: Page) -> None:
    page.ask(lambda told: (told("half"), threading.get_ident())[1])
    page.until(lambda: bool(page.results))
    assert page.results[0] != threading.get_ident()
    assert page.news == ["half"]


def test_nothing_is_said_of_work_that_is_soon_finished(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(desks, "QUIET", LONG)
    page.ask(lambda told: told("half"))
    page.until(lambda: bool(page.results))
    assert page.news == []


def test_the_latest_of_the_requests_that_wait_is_the_next_one(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(desks, "TIME_TO_FINISH", LONG)
    first = Held("first")
    page.ask(first)
    assert first.begun.wait(LONG)
    for number in range(5):
        page.ask(lambda told, number=number: number)
    first.go.set()
    page.until(lambda: len(page.results) == 2)
    assert page.results == ["first", 4]


def test_work_that_takes_long_is_dropped_for_a_newer_request(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(desks, "TIME_TO_FINISH", 0.0)
    long = Held()
    page.ask(long)
    assert long.begun.wait(LONG)
    page.ask(lambda told: "new")
    page.until(lambda: bool(page.results))
    assert (page.results, page.faults, long.end) == (["new"], [], "Dropped")


def test_stop_shows_what_there_is_and_the_desk_goes_on(page: Page) -> None:
    long = Held()
    page.ask(long)
    assert long.begun.wait(LONG)
    page.desk.stop()
    page.until(lambda: bool(page.results))
    page.ask(lambda told: "next")
    page.until(lambda: len(page.results) == 2)
    assert page.results == ["held so far", "next"]


def test_stop_before_there_is_anything_is_one_line(page: Page) -> None:
    def work(told: Callable[[str], None]) -> None:
        while True:
            told("not yet")
            time.sleep(0.005)

    page.ask(work)
    page.until(lambda: bool(page.news))
    page.desk.stop()
    page.until(lambda: bool(page.faults))
    assert page.faults == [desks.STOPPED_EARLY]


def test_a_mistake_of_the_user_is_shown_as_it_is(page: Page, caplog: pytest.LogCaptureFixture) -> None:
    def work(told: object) -> None:
        raise InputError("alpha must be positive")

    page.ask(work)
    page.until(lambda: bool(page.faults))
    assert page.faults == ["alpha must be positive"]
    assert caplog.records == []


def test_a_fault_of_the_program_is_one_line_on_the_page_and_a_traceback_in_the_log(
    page: Page, caplog: pytest.LogCaptureFixture
) -> None:
    page.ask(lambda told: {}["no such\nkey"])
    page.until(lambda: bool(page.faults))
    assert page.faults == [r"this cannot be shown, because of a program fault (KeyError: 'no such\nkey')"]
    assert "Traceback" in caplog.text
    page.ask(lambda told: "alive")
    page.until(lambda: bool(page.results))
    assert page.results == ["alive"]


def test_nothing_is_begun_before_the_page_has_shown_the_last_result(page: Page) -> None:
    """A page that is slow to draw is not flooded with pictures."""
    second = Held()
    page.ask(lambda told: "first")
    show = page.calls.get(timeout=LONG)
    page.ask(second)
    assert not second.begun.wait(0.05)
    show()
    assert second.begun.wait(LONG)


def test_of_progress_that_waits_for_the_page_only_the_latest_is_kept(page: Page) -> None:
    page.ask(lambda told: [told(str(number)) for number in range(100)])
    page.until(lambda: bool(page.results))
    assert page.news[-1] == "99"
    assert len(page.news) <= 2  # one may have been fetched while the others came


def test_closing_ends_the_work_and_its_thread(page: Page) -> None:
    long = Held()
    page.ask(long)
    assert long.begun.wait(LONG)
    (thread,) = [one for one in threading.enumerate() if one is page.desk._thread]
    page.desk.close()
    thread.join(LONG)
    assert not thread.is_alive()
    assert (long.end, page.results) == ("Dropped", [])
    page.ask(lambda told: "too late")
    assert not page.desk.is_at_work


def test_one_desk_does_not_wait_for_another(page: Page) -> None:
    other, long = Page(), Held()
    page.ask(long)
    assert long.begun.wait(LONG)
    other.ask(lambda told: "at once")
    other.until(lambda: bool(other.results))
    assert not long.ended.is_set()
    other.desk.close()


def test_a_run_of_days_ends_for_a_newer_value_at_a_stop_and_with_its_page(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    """The work of the explorer itself: a newer value drops it, a stop shows it as far as it came, and no run outlives its page."""
    monkeypatch.setattr(solving, "MOST_PIECES", 10**9)
    monkeypatch.setattr(desks, "TIME_TO_FINISH", 0.0)
    days = {"body.contact_mass": 1e6, "loading.pull_rate": 0.1, "run.duration": 1e9, "run.rtol": 1e-12}
    endless = partial(solve, load_scenario("fig6-slab").with_values(days))

    def begin() -> None:
        page.news.clear()
        page.ask(endless)
        page.until(lambda: bool(page.news))

    begin()
    page.ask(lambda told: "the new one")
    page.until(lambda: bool(page.results))
    assert page.results == ["the new one"]
    begin()
    page.desk.stop()
    page.until(lambda: len(page.results) == 2)
    assert page.results[1].solution.status.name == "interrupted"
    assert len(page.results[1].solution.history) > 0
    begin()
    thread = page.desk._thread
    page.desk.close()
    thread.join(LONG)
    assert not thread.is_alive()
    assert (len(page.results), page.faults) == (2, [])
