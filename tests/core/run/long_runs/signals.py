"""Ctrl-C at many moments of what is done."""

from __future__ import annotations

import signal
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import stickslip as ss

PHASES = 12
"""Number of moments of a run at which a signal comes."""


def with_signal_at(call: int, act: Callable[[], Any]) -> tuple[Any, int]:
    """Return what `act` returns, or KeyboardInterrupt if it raises that, with a Ctrl-C at one of its calls of our functions.

    The calls are numbered; at -1 there is none. The second number returned is how many there were. The signal comes once, as a
    function of ours begins. In a library's own functions, or as one of C is called, it might leave a lock closed, on which other
    tests would wait for ever: only a profiler interrupts `with lock` before its `__exit__`.
    """
    seen, ours = 0, str(Path(ss.__file__).parent)

    def count(frame: FrameType, event: str, _: Any) -> None:
        nonlocal seen
        if event == "call" and frame.f_code.co_filename.startswith(ours):
            seen += 1
            if seen == call:
                signal.raise_signal(signal.SIGINT)

    sys.setprofile(count)
    try:
        return act(), seen
    except KeyboardInterrupt:
        return KeyboardInterrupt, seen
    finally:
        sys.setprofile(None)


def lost(act: Callable[[], Any], is_heard: Callable[[Any], bool]) -> list[int]:
    """Return the phases, of PHASES that are spread over all that `act` does, at which a signal has no consequence."""
    act()  # compiles
    count = with_signal_at(-1, act)[1]
    phases = sorted({1 + i * (count - 1) // PHASES for i in range(PHASES)})
    return [phase for phase in phases if not is_heard(with_signal_at(phase, act)[0])]


def heard(found: Any) -> bool:
    return found is KeyboardInterrupt or found.status.name == "interrupted"
