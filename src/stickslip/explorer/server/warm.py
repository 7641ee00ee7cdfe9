"""Warm the compiler when the explorer starts: load or compile what runs need before the first one is asked for."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field

from stickslip.explorer.model.strip import StripRange
from stickslip.explorer.server.desk import unforeseen

FIRST_RUNS = (("fig6-slab", 20.0), ("fig6-block-reconstructed", 20.0), ("rate-and-state-block", 1.0), ("fig4-loop", 1.0))
"""Scenarios, each with a duration (s), that between them use the parts of the engine that most runs need."""
FIRST_STRIP, FEW = StripRange("friction.alpha", 0.05, 2.0), 16
"""A strip, and a number of its runs, by which batches are warmed."""
LINE = "The engine is being loaded: the first picture takes a moment longer."


@dataclass(eq=False)
class Warming:
    """The warming of the compiler, in a thread of its own; pages ask for its `line` and are told when it changes."""

    line: str = LINE
    _calls: list[Callable[[str], None]] = field(default_factory=list)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def begin(self) -> None:
        """Begin in the background."""
        threading.Thread(target=self._warm, name="explorer-warming", daemon=True).start()

    def tell(self, call: Callable[[str], None]) -> Callable[[], None]:
        """Have `call` called with the present line and, from another thread, with later ones. Returns what ends that."""
        with self._lock:
            self._calls.append(call)
        call(self.line)
        return lambda: self._calls.remove(call) if call in self._calls else None

    def _say(self, line: str) -> None:
        self.line = line
        with self._lock:
            calls = list(self._calls)
        for call in calls:
            call(line)

    def _warm(self) -> None:
        try:
            from stickslip.engine.codegen.cache import announce_by, tell
            from stickslip.explorer.model.strip import strip_of
            from stickslip.run.simulate import simulate
            from stickslip.scenarios.scenario import load_scenario

            announce_by(lambda text: self._say(f"{text[0].upper()}{text[1:]}."))
            try:
                for name, duration in FIRST_RUNS:
                    simulate(load_scenario(name), duration)
                strip_of(load_scenario(FIRST_RUNS[0][0]), FIRST_STRIP, members=FEW)
            finally:
                announce_by(tell)
        except Exception as error:  # pages say what is wrong when they run into it themselves
            unforeseen(error)
        finally:
            self._say("")
