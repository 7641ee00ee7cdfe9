"""The options of one call: those of a run, and how it is watched, stored and bounded."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from stickslip.foundation.conversion import Number, WithUnit
from stickslip.foundation.locks import held
from stickslip.foundation.quantities import Quantity, declare
from stickslip.problem import DURATION, ENOUGH_EVENTS, MAX_PIECES, STATUSES, TOO_MANY, BoundedOptions
from stickslip.problem.scenarios import Scenario
from stickslip.run.words import CHECKPOINT_EVERY

if TYPE_CHECKING:
    from stickslip.solution import Solution

CHECKPOINT_INTERVAL = Quantity("s", "wall-clock time between two checkpoints", at_least=0, infinite=True)


@dataclass(frozen=True)
class CallOptions(BoundedOptions):
    """The options of a run, and what only the call has: see `stickslip.simulate`."""

    duration: Number = declare(DURATION)  # again, as in `BoundedOptions`
    progress: Callable[[Any], object] | None = None
    checkpoint: Path | None = None
    checkpoint_every: Number = declare(CHECKPOINT_INTERVAL, CHECKPOINT_EVERY)
    of_solver: Mapping[str, Any] = field(default_factory=dict)
    """Options of the solver of an extension, by name, which that solver checks."""

    @classmethod
    def of(cls, source: Any, **given: Any) -> Self:
        """Return the options, not yet checked, for a scenario or what an extension solves: those `given`, or its own where None."""
        own = vars(source.options) | {"title": source.heading} if isinstance(source, Scenario) else {"duration": None}
        return cls(**(own | {name: value for name, value in given.items() if value is not None}))

    @classmethod
    def to_continue(cls, stopped: Solution, duration: float | str | WithUnit | None, **given: Any) -> Self:
        """Return the options to continue a stopped run: those `given`, and for those that are None its own or the defaults.

        A run that has already had its number of events continues without one. Without a limit of its own it may come to half as
        many pieces again as it has, unless it has stopped because it had as many as it was allowed.
        """
        had_them, had = stopped.status == STATUSES[ENOUGH_EVENTS], len(stopped.history)
        if given.get("max_pieces") is None and stopped.status.name != TOO_MANY:
            given["max_pieces"] = max(MAX_PIECES, had + had // 2)
        own = vars(stopped.options) | ({"max_events": None} if had_them else {})
        return cls(**own).with_given({"duration": duration} | given)

    def alone(self) -> AbstractContextManager[None]:
        """Reserve the run's file, if it has one, against other runs until the `with` block ends.

        Raises InputError if another run is writing into it, or if nothing can be written beside it.
        """
        if self.checkpoint is None:
            return nullcontext()
        return held(self.checkpoint, f"{self.checkpoint}: another run is writing into it: choose another name")
