"""The two runs of a setting: the one that was asked for, and that of a companion of the other kind."""

from __future__ import annotations

from dataclasses import replace

from stickslip.bodies import ElasticSlab
from stickslip.explorer.model.stop import Stopped, Told
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem
from stickslip.run.simulate import simulate
from stickslip.scenarios.scenario import Scenario, load_scenario
from stickslip.solution.solution import Solution
from stickslip.studies.analogy import block_for

MOST_PIECES = 100_000
"""Largest number of pieces of a history: some 45 MB, so that several pages fit into memory."""
SLABS = {"fig5-block": "fig5-slab-printed", "fig6-block": "fig6-slab", "fig7-block": "fig7-slab-critical"}
"""Bundled slab that the paper shows beside a bundled block, by the beginning of the block's name."""


def run(scenario: Scenario, told: Told) -> Solution:
    """Run a scenario, with a bounded history. Raises InputError if it cannot even start, or was stopped before it did."""
    try:
        return simulate(scenario, progress=lambda report: told(str(report)), max_pieces=MOST_PIECES)
    except Stopped:
        raise InputError(f"{scenario.name}: stopped before the run had begun") from None


def companion_of(scenario: Scenario) -> Scenario | None:
    """Return the scenario of the companion, or None if there is none.

    For a slab it is its equivalent block, for each m^2 of contact, so that its forces in N are the slab's stresses in Pa. For a
    block of the paper it is the slab of the same figure, under the law, the loading and the rule of the block.
    """
    try:
        if scenario.problem.body.has_waves:
            return replace(scenario, problem=block_for(scenario.problem), creep_rtol=None, shortest_event=None)
        slab = slab_of_figure(scenario.name)
        return None if slab is None else replace(scenario, problem=_slab_beside(scenario.problem, load_scenario(slab).problem))
    except InputError:  # such as a driver that is not rigid
        return None


def slab_of_figure(name: str) -> str | None:
    """Return the name of the bundled slab that the paper shows beside a bundled block, or None for another name."""
    return next((slab for start, slab in SLABS.items() if name.startswith(start)), None)


def _slab_beside(block: Problem, slab: Problem) -> Problem:
    assert isinstance(slab.body, ElasticSlab)
    return replace(slab, friction=block.friction, pull_rate=block.pull_rate, selection=block.selection)


def run_companion(scenario: Scenario, told: Told) -> Solution | None:
    """Run the companion of a scenario, or return None if it has none, or if its run cannot start."""
    other = companion_of(scenario)
    try:
        return None if other is None else run(other, lambda text: told(f"{_kind(other)}: {text}"))
    except InputError:
        return None


def _kind(scenario: Scenario) -> str:
    return "slab" if scenario.problem.body.has_waves else "equivalent block"
