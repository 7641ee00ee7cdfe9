"""How long the explorer takes from a slider to the picture: `python -m benchmarks.explorer`, a minute.

For the paper's cases a control is moved again and again, as a user does. Reported is processor time of the server: the answer
(run, companion and all that is shown of them) and the picture (the models of Bokeh, brought up to date, and written as the message
that goes to the browser). Values differ each time, so nothing is remembered. Minima of repeated measurements.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from stickslip.explorer.model.setting import Setting
from stickslip.explorer.model.solve import solve
from stickslip.explorer.model.strip import StripRange, strip_of
from stickslip.explorer.page.panels import plots, view_of
from stickslip.explorer.page.stage import Stage

CASES = (
    ("fig5-slab-printed", "friction.wavenumber", 5.0),
    ("fig5-slab-reconstructed", "friction.wavenumber", 50.0),
    ("fig5-block-reconstructed-k", "friction.wavenumber", 5.0),
    ("fig6-slab", "friction.alpha", 1.0),
    ("fig6-block-reconstructed", "friction.alpha", 1.0),
    ("fig7-slab-critical", "friction.alpha", 0.196001),
    ("fig4-loop", "friction.alpha", 1.0),
)
"""Scenario, the control that is moved, and where it begins."""
REPEATS = 15


def least(work: Callable[[int], Any], repeats: int = REPEATS) -> float:
    """The smallest processor time (ms) of one piece of work, which is given its number."""
    taken = []
    for k in range(repeats):
        start = time.process_time()
        work(k)
        taken.append(time.process_time() - start)
    return 1e3 * min(taken)


def drawn() -> tuple[Stage, Any]:
    """The plots of a page in a document that gathers what would be sent."""
    from bokeh.document import Document

    stage, document = Stage(), Document()
    for plot in plots(stage).values():
        document.add_root(plot)
    return stage, document


def message_of(stage: Stage, document: Any, view: Any) -> int:
    """Bring a view to the plots, and return the size (bytes) of the message to the browser."""
    from bokeh.protocol import Protocol

    events: list[Any] = []
    document.on_change(events.append)
    document.hold("combine")
    stage.show(view)
    document.unhold()
    document.remove_on_change(events.append)
    message = Protocol().create("PATCH-DOC", events)
    return sum(len(str(part)) for part in (message.content_json, message.header_json)) + sum(
        memoryview(one.data).nbytes for one in message.buffers
    )


def measure(name: str, path: str, value: float) -> tuple[float, float, float, float]:
    """Processor time (ms) of answer, picture and message, and of a strip of 200 runs; the message in kB."""
    setting = Setting.bundled(name)
    settings = [setting.with_value(path, value * (1.0 + 1e-4 * k)) for k in range(REPEATS)]
    solve(setting.scenario())
    answers = [solve(one.scenario()) for one in settings[:3]]
    stage, document = drawn()
    sizes: list[int] = []
    answer = least(lambda k: solve(settings[k].scenario()))
    picture = least(lambda k: sizes.append(message_of(stage, document, view_of(answers[k % 3]))))
    where = StripRange(path, 0.5 * value, 2.0 * value)
    strip_of(setting.scenario(), where)
    strip = least(lambda k: strip_of(setting.scenario(), where), 5)
    return answer, picture, max(sizes) / 1e3, strip


def main() -> None:
    """Print the table of benchmarks/README.md."""
    out = sys.stdout.write
    out("| scenario | control | answer | picture | slider to picture | message | strip of 200 runs |\n")
    out(f"|{' --- |' * 7}\n")
    for name, path, value in CASES:
        answer, picture, size, strip = measure(name, path, value)
        both = answer + picture
        out(f"| {name} | {path} | {answer:.0f} ms | {picture:.0f} ms | {both:.0f} ms | {size:.0f} kB | {strip:.0f} ms |\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
