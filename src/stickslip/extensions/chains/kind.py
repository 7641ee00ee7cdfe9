"""What the core asks of chains: their solver, and the reader of their folders."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.extensions.chains.deciding import DECIDING_CODE
from stickslip.foundation.errors import InputError
from stickslip.run import ALL_TAKE, Reader, SolverKind

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from stickslip.cli.kinds import KindOfRun
    from stickslip.cli.results import Stored
    from stickslip.extensions.chains.run import ChainRun
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import CallOptions


def _solves(what: Any) -> bool:
    from stickslip.extensions.chains.chain import Chain

    return isinstance(what, Chain)


def _run(source: Any, options: CallOptions) -> ChainRun:
    from stickslip.extensions.chains.running import simulate_chain

    return simulate_chain(source, options)


def _on_command_line() -> KindOfRun:
    from stickslip.extensions.chains.command_line import KindOfChain

    return KindOfChain()


def _examine(scenario: Scenario) -> Any:
    from stickslip.extensions.chains.examine import ChainExamination

    return ChainExamination(scenario)


def _summaries() -> Mapping[str, tuple[str, str, Callable[[Any], float]]]:
    from stickslip.extensions.chains.swept import SUMMARIES

    return SUMMARIES


CHAIN_SOLVER = SolverKind(
    _solves,
    _run,
    ALL_TAKE | {"max_events", "title", "keep"},
    "a Chain has no {}: its events are located to rounding",
    _on_command_line,
    _examine,
    what="a Chain",
    summaries=_summaries,
    code=(*DECIDING_CODE, "extensions/chains/swept.py"),
)
"""The solver of chains, and of scenarios with a [chain]."""


class ChainReader(Reader):
    """Reads the folder of zarr that holds the run of a chain."""

    what = "the run of a chain"

    @override
    def is_in(self, path: Path) -> bool:
        if not path.is_dir():
            return False
        from stickslip.extensions.chains.store_layout import CHAIN_FORMAT

        return CHAIN_FORMAT.is_in(path)

    @override
    def open(self, path: Path) -> ChainRun:
        from stickslip.extensions.chains.store_layout import open_chain

        return open_chain(path)

    @override
    def resume(self, path: Path, duration: Any, **options: Any) -> ChainRun:
        from stickslip.extensions.chains.running import resume_chain

        needless = [name for name in ("checkpoint", "max_pieces") if options.pop(name, None) is not None]
        if needless:
            raise InputError(f"resume: {path}: the run of a chain continues in its own folder, without {needless[0]}")
        return resume_chain(path, duration, **{name: value for name, value in options.items() if value is not None})

    @override
    def stored(self, path: Path) -> Stored:
        from stickslip.cli.results import Stored
        from stickslip.extensions.chains.command_line import ChainResults
        from stickslip.extensions.chains.store_layout import open_chain, opened, scenario_in

        about, scenario = opened(path).attrs, scenario_in(path)
        return Stored(path, about, ChainResults(scenario, open_chain(path)), scenario.to_toml())

    @override
    def on_command_line(self) -> KindOfRun:
        return _on_command_line()
