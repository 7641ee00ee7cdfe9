"""What the core asks of chains: their solver, and the reader of their folders."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from stickslip.run import ALL_TAKE, SolverKind

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import CallOptions


def _solves(what: Any) -> bool:
    from stickslip.extensions.chains.chain import Chain

    return isinstance(what, Chain)


def _run(source: Any, options: CallOptions) -> ChainRun:
    from stickslip.extensions.chains.running import simulate_chain

    return simulate_chain(source, options)


def _examine(scenario: Scenario) -> Any:
    from stickslip.extensions.chains.examine import ChainExamination

    return ChainExamination(scenario)


CHAIN_SOLVER = SolverKind(
    _solves,
    _run,
    ALL_TAKE | {"max_events", "title", "keep"},
    "a Chain has no {}: its events are located to rounding",
    examine=_examine,
    what="a Chain",
)
"""The solver of chains, and of scenarios with a [chain]."""
