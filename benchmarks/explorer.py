"""How long the explorer takes from a slider to the picture: `python -m benchmarks.explorer`, two minutes.

For the paper's cases a control is moved again and again, as a user does. Values differ each time, so nothing is remembered. The
first table is processor time of what the server works out: the answer (run, companion and all that is shown of them) and the
picture (units, columns and texts, written as the block of bytes that goes to the browser); minima of repeated measurements. The
second table is that of a real page, server and browser together.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

from benchmarks.explorer_in_browser import print_table
from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.model.strip import MEMBERS, strip_of
from stickslip.extensions.explorer.page.page import TITLES_OF_PANELS
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.extensions.explorer.page.view import headings_of, view_bytes
from stickslip.foundation.axis import Axis

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


def picture_of(answer: Answer) -> bytes:
    """Return what is sent of an answer."""
    view = view_of(answer)
    return view_bytes(view, headings_of(view, TITLES_OF_PANELS))


def measure(name: str, path: str, value: float) -> tuple[float, float, float, float]:
    """Processor time (ms) of answer, picture and message, and of a strip of 200 runs; the message in kB."""
    setting = Setting.bundled(name)
    settings = [setting.with_value(path, value * (1.0 + 1e-4 * k)) for k in range(REPEATS)]
    solve(setting.scenario())
    answers = [solve(one.scenario()) for one in settings[:3]]
    size = max(len(picture_of(one)) for one in answers)
    answer = least(lambda k: solve(settings[k].scenario()))
    picture = least(lambda k: picture_of(answers[k % 3]))
    where = Axis(path, 0.5 * value, 2.0 * value, MEMBERS)
    strip_of(setting.scenario(), where)
    strip = least(lambda k: strip_of(setting.scenario(), where), 5)
    return answer, picture, size / 1e3, strip


def main() -> None:
    """Print the tables of benchmarks/README.md."""
    out = sys.stdout.write
    out("| scenario | control | answer | picture | slider to picture | message | strip of 200 runs |\n")
    out(f"|{' --- |' * 7}\n")
    for name, path, value in CASES:
        answer, picture, size, strip = measure(name, path, value)
        both = answer + picture
        out(f"| {name} | {path} | {answer:.0f} ms | {picture:.0f} ms | {both:.0f} ms | {size:.0f} kB | {strip:.0f} ms |\n")
        sys.stdout.flush()
    out("\n")
    print_table(out)


if __name__ == "__main__":
    main()
