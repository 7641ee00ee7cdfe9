"""The options of a run as they are typed, with what `run.words` says of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any

from stickslip.cli.options import ACCURACY, complete_rule, option
from stickslip.run import WORDS

GOES_ON = "A run that needs more ends there; --out keeps what there is, and --resume goes on with a larger number."
"""What --max-pieces says of the files of the command line."""


def _typed(name: str, *names: str, more: str = "", **how: Any) -> Any:
    """Declare an option with what is said of it."""
    return option(f"{WORDS[name].meaning} {more}".strip(), *names, **how)


@dataclass(frozen=True)
class TypedOptions:
    """The options of a run that were typed; None is not typed."""

    duration: Annotated[str | None, _typed("duration")] = None
    max_events: Annotated[int | None, _typed("max_events", "--events")] = None
    selection: Annotated[str | None, _typed("selection", autocompletion=complete_rule)] = None
    rtol: Annotated[float | None, _typed("rtol", panel=ACCURACY)] = None
    creep_rtol: Annotated[float | None, _typed("creep_rtol", panel=ACCURACY)] = None
    shortest_event: Annotated[str | None, _typed("shortest_event", panel=ACCURACY)] = None
    max_pieces: Annotated[int | None, _typed("max_pieces", more=GOES_ON, min=1, metavar="<int>", panel=ACCURACY)] = None

    @property
    def replaced(self) -> dict[str, Any]:
        """What replaces an option of the scenario, or its selection rule, by name; None was not typed."""
        return {name: value for name, value in vars(self).items() if name != "max_pieces"}
