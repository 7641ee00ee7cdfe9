"""One open page: the setting of its controls, the answer that is shown, and what listens to them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any, Literal, Protocol, TypeVar

from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.fault import FaultAnswer
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import Told
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError, gathered
from stickslip.problem.scenarios import Scenario

Shown = TypeVar("Shown", Answer, FaultAnswer)
News = Literal["setting", "answer", "fault", "progress", "pin", "cursor", "tour", "strip"]
"""What the parts of a page can listen to."""
OTHER_PAGE = "{name}: a fault in 2D and a contact of one place have pages of their own: open it with `stickslip explore`"
"""What is said of a setting that another page shows."""
NOISY = "the points look noisy"
"""What a warning of noisy points says; an answer's own notes say it too, with the number of folds that the noise makes."""


class Desk(Protocol):
    """Where the work of one page is done, so that it does not wait: at most one piece of work at a time, and the latest counts."""

    def ask(
        self, work: Callable[[Callable[[str], None]], Any], done: Callable[[Any], None], failed: Callable[[Exception], None]
    ) -> None:
        """Begin `work` beside the page and drop work that is under way or waits; then call `done` or `failed` on the page."""

    def stop(self) -> None:
        """Stop the work that is under way; what it has calculated so far is its result."""


class Explorer:
    """The centre of a page. Parts of it change the setting here, and are told here of the answer.

    `setting` is what the controls hold. It is always one that could be read: a bad entry never gets here, and `fault` says in one
    line what was wrong with it. `answer` is None before the first one, and `shown` is it with its own setting, since the controls
    may be newer; `pinned` is the run with which it is compared. Work on `files` does not drop the work on an answer. `cursor` is
    the time (s) at which all panels show the cursor, `tour` the step of the tour that is shown, from 1, and `strip` the range of
    the strip.
    """

    def __init__(self, setting: Setting, desk: Desk, answer: Callable[..., Any], files: Desk | None = None) -> None:
        self.setting, self.answer, self.shown, self.pinned = setting, None, None, None
        self.fault, self.progress, self.cursor = "", "", 0.0
        self.tour, self.strip = 0, None
        self._asked = self._shown = 0
        self._desk, self._calculate = desk, answer
        self.files = files or desk
        self._listeners: dict[News, list[Callable[[], None]]] = {}
        self._once: list[Callable[[], None]] = []

    answer: Any
    shown: tuple[Setting, Any] | None
    pinned: tuple[Setting, Any] | None
    strip: Axis | None

    def listen(self, news: News, call: Callable[[], None]) -> None:
        """Have `call` called whenever there are news of this kind."""
        self._listeners.setdefault(news, []).append(call)

    def tell(self, news: News) -> None:
        """Tell all that listen to these news."""
        for call in self._listeners.get(news, ()):
            call()

    def change(self, setting: Setting, cursor: float | None = None) -> None:
        """Take a new setting and ask for its answer; if it cannot be read, say why and keep the last good picture.

        With the answer the cursor moves to the time `cursor` (s), if one is given.
        """
        try:
            if setting.is_fault != self.setting.is_fault:
                raise InputError(OTHER_PAGE.format(name=setting.name))
            scenario, doubts = setting.read()
        except InputError as error:
            self.refuse(str(error))
            return
        self.setting = setting
        self.tell("setting")
        self._asked += 1
        number = self._asked
        self._desk.ask(
            lambda told: self._answered(scenario, doubts, told),
            lambda answer: self._show((setting, answer), number, cursor),
            self._fail,
        )

    def _answered(self, scenario: Scenario, doubts: tuple[str, ...], told: Told) -> Any:
        """Return the answer, with doubts about the setting and those that came up meanwhile among its notes."""
        with gathered() as more:
            answer = self._calculate(scenario, told)
        return with_notes(answer, (*doubts, *more))

    def read(self, work: Callable[[], Any], done: Callable[[Any], None]) -> None:
        """Have something read beside the page, and call `done` with it; if it cannot be read, say why."""
        self._desk.ask(lambda told: work(), done, self._fail)

    def once_answered(self, call: Callable[[], None]) -> None:
        """Have `call` called once, after the next answer is shown; not at all if there is a fault in its place."""
        self._once.append(call)

    def beside(self, work: Callable[[Callable[[str], None]], Any], done: Callable[[Any], None]) -> None:
        """Have something more worked out about the run that is shown, such as a strip; the next change of the setting drops it.

        While a newer setting waits for its answer nothing is begun: that answer tells its news in turn.
        """
        if self._shown == self._asked:
            self._desk.ask(work, done, self._fail)

    def show_step(self, step: int, setting: Setting | None, strip: Axis | None, cursor: float) -> None:
        """Show a step of the tour: its setting, strip and cursor; 0 closes the tour and leaves the page as it is."""
        self.tour = step
        self.tell("tour")
        if setting is not None:
            self.change(setting, cursor)
            self.show_strip(strip)

    def show_strip(self, strip: Axis | None) -> None:
        """Show a strip, or none."""
        self.strip = strip
        self.tell("strip")

    def refuse(self, fault: str) -> None:
        """Say what is wrong with an entry; the last good picture stays."""
        self.fault = fault
        self.tell("fault")

    def told(self, progress: str) -> None:
        """Show a line on the work that is under way."""
        self.progress = progress
        self.tell("progress")

    def stop(self) -> None:
        """Stop a long run; it is shown up to where it got."""
        self._desk.stop()

    def pin(self) -> None:
        """Keep the run that is shown, to compare the next ones with it; or let go of the one that is kept."""
        self.pinned = None if self.pinned else self.shown
        self.tell("pin")

    def _show(self, shown: tuple[Setting, Any], number: int, cursor: float | None) -> None:
        self.shown, self.answer, self.fault, self.progress, self._shown = shown, shown[1], "", "", number
        if cursor is not None:
            self.cursor = cursor
        for news in ("fault", "progress", "answer"):
            self.tell(news)
        if cursor is not None:
            self.tell("cursor")
        waiting, self._once = self._once, []
        for call in waiting:
            call()

    def _fail(self, error: Exception) -> None:
        self.progress, self._once = "", []
        self.tell("progress")
        if not isinstance(error, InputError):
            raise error
        self.refuse(str(error))


def with_notes(answer: Shown, notes: Iterable[str]) -> Shown:
    """Return an answer with further notes, without those that it holds already in other words or that come twice."""
    further: tuple[str, ...] = tuple(note for note in dict.fromkeys(notes) if NOISY not in note and note not in answer.notes)
    return replace(answer, notes=(*answer.notes, *further)) if further else answer
