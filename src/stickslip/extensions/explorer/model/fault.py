"""Answer a scenario of a fault in 2D: run it, and work out what the page shows of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.extensions.explorer.model.answer import BodyCurves, EnergyPicture, KeyNumber, Mark, short
from stickslip.foundation.errors import InputError
from stickslip.problem import in_given_units
from stickslip.problem.scenarios import Scenario
from stickslip.run.simulate import simulate

if TYPE_CHECKING:
    from stickslip.extensions.planar import PlanarSolution

MOST_MEMORY = 1e9
"""Memory (bytes) that the run of a page may take: several pages are open at once."""


Told = Callable[[str], None]
"""A function that is told in one line how far a run is."""


@dataclass(frozen=True)
class FaultAnswer:
    """All that the explorer shows of a fault in 2D: the fields that it shares with an `Answer` mean the same there.

    `motions` holds the motion of the node in the middle. `energy` is None if it would take long to know.
    """

    scenario: Scenario
    run: PlanarSolution
    sentence: str
    motions: tuple[BodyCurves, ...]
    energy: EnergyPicture | None
    marks: tuple[Mark, ...]
    numbers: tuple[KeyNumber, ...]
    notes: tuple[str, ...]
    regime: str = ""
    """What the slip rate follows from is said of a contact of one place only."""


@in_given_units
def solve_fault(scenario: Scenario, told: Told) -> FaultAnswer:
    """Run a scenario; `told` is called with lines on its progress, and may raise `Stopped` to end the run there.

    Raises InputError, in one line, if the run needs more memory than a page may take.
    """
    from stickslip.extensions.planar import memory_of_run

    needed = memory_of_run(scenario)
    if needed > MOST_MEMORY:
        raise InputError(
            f"{scenario.name}: this run needs {needed / 1e9:.3g} GB, and a page has {MOST_MEMORY / 1e9:g} GB: take fewer nodes, a"
            " shorter duration, or `stickslip run`"
        )
    run: Any = simulate(scenario, progress=lambda report: told(str(report)))
    sentences = run.sentences
    return FaultAnswer(
        scenario=scenario,
        run=run,
        sentence=" ".join(sentences[:3]),
        motions=(_in_the_middle(run),),
        energy=_energy(run),
        marks=tuple(_marks(run)),
        numbers=_numbers(run),
        notes=(*([] if run.status.ok else [str(run.status)]), *sentences[3:]),
    )


def _in_the_middle(run: PlanarSolution) -> BodyCurves:
    slip, rate, traction = (one[:, run.slab.nodes // 2] for one in (run.slip, run.slip_rate, run.traction))
    load = traction + run.slab.body.impedance * rate
    return BodyCurves("slab", "in the middle", run.times, slip, rate, traction, load, "Pa", run.slab.body.normal_stress)


def _energy(run: PlanarSolution) -> EnergyPicture | None:
    """Return elastic energy above its smallest value, kinetic energy and heat, and the total with the work of the driver."""
    if not run.knows_energy:
        return None
    found = run.energy()
    parts = {name: found[name].to_numpy() for name in ("elastic", "kinetic", "heat")}
    least = float(parts["elastic"].min())
    parts |= {"elastic": parts["elastic"] - least, "total": found["work"].to_numpy() - least}
    return EnergyPicture(run.times, parts, "J/m")


def _marks(run: PlanarSolution) -> Iterator[Mark]:
    if run.has_slipped.any():
        first = float(np.nanmin(run.rupture_times))
        yield Mark(first, "start", f"slip begins at {short(first, 's')}")
    echoes = run.slab.body.two_way_time * np.arange(1, 1 + int(run.times[-1] / run.slab.body.two_way_time))
    for time in echoes.tolist()[:20]:
        yield Mark(time, "echo", f"the echo of what was sent at the start of this round trip arrives at {short(time, 's')}")
    moving = np.flatnonzero(run.slip_rate.any(axis=1))
    if moving.size and moving[-1] + 1 < len(run.times):
        rest = float(run.times[moving[-1] + 1])
        yield Mark(rest, "arrest", f"all nodes rest from {short(rest, 's')} on")


def _numbers(run: PlanarSolution) -> tuple[KeyNumber, ...]:
    nothing = not run.has_slipped.any()
    return (
        KeyNumber("share of the contact that slips", float(run.has_slipped.mean()), "1"),
        KeyNumber("largest slip", float(np.ptp(run.slip, axis=0).max()), "m"),
        KeyNumber("slip in the middle", float(np.ptp(run.slip[:, run.slab.nodes // 2])), "m"),
        KeyNumber("largest slip rate", float(np.abs(run.slip_rate).max()), "m/s"),
        KeyNumber("pulses in the middle", float(run.middle(run.pulses)), "1"),
        KeyNumber("first slip", np.nan if nothing else float(np.nanmin(run.rupture_times)), "s"),
        KeyNumber("nodes in the process zone", run.nodes_per_process_zone, "1"),
    )
