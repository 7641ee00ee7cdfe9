"""All that is proven, or measured, of a finished run from its history and its problem, whatever made it, in one sentence.

Together these are the equations of a run: the contact equation and the equations of states (proven bounds); the loads that waves,
spring, drivers and ground make (compared at places); rest below the strength; slip as the integral of its rate. What is not among
them: which of several slip rates the selection rule takes, and leaps, which have error bounds of their own.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from typing import ClassVar

from stickslip.engine import History
from stickslip.foundation.show import brief, brief_repr
from stickslip.solution.observables.proof import Proof, proven
from stickslip.solution.observables.proof_of_load import load_compared
from stickslip.solution.observables.proof_of_rest import exceeded_at_rest
from stickslip.solution.observables.proof_of_slip import slip_joined
from stickslip.solution.observables.proof_of_states import states_proven


@dataclass(frozen=True)
class ProofOfRun(Proof):
    """What a run misses of its equations, seen from its history and its problem alone: bounds, and what was measured beside them.

    Normal load, evolution of states, far stress, ground and drivers are those of the problem, not those that the engine wrote.
    Loads are compared at places in steps, in a short run in all of them; the energy balance covers those of the others, too.
    """

    states: float = 0.0
    """Largest bound on what a step adds to a state of the law without its evolution equation, relative to the state."""
    states_unproven: int = 0
    """Number of steps where that is known at places only."""
    load: float = 0.0
    """Largest difference, in `unit`, between a load and the one that slip, waves or spring, drivers and ground make."""
    compared: int = 0
    """Number of steps, and of recorded rests, where loads were compared."""
    pieces: int = 0
    """Number of steps, and of recorded rests, of the run."""
    rest: float = 0.0
    """Largest load above the static strength while the contact rests, or below it where slip begins, in `unit`."""
    slip: float = 0.0
    """Largest difference (m, or rad) between a slip and the integral of the slip rate, step by step."""
    rate: float = 0.0
    """Largest jump (m/s, or rad/s) of the slip rate of a contact with mass."""

    units: ClassVar[dict[str, str]] = Proof.units | {"states": "1"}
    __repr__ = brief_repr

    @property
    def text(self) -> str:
        """What holds, how it is known, and what covers the rest: one line."""
        found = super().text
        if self.states or self.states_unproven:
            found += f"; states obey their equations to {self.states:.1g} of themselves in each step"
            if self.states_unproven:
                found += f", in {self.states_unproven} of them as measured at places"
        part = "all" if self.compared == self.pieces else f"{self.compared} of {self.pieces}"
        if self.compared:
            found += f"; loads follow from slip and loading to {brief(self.load, self.unit)}, compared in {part} pieces"
        if self.compared < self.pieces:
            found += "; only the energy balance covers loads in the other pieces"
        if self.rest:
            found += f"; rest and strength differ by up to {brief(self.rest, self.unit)}"
        return found


def proof_of_run(history: History) -> ProofOfRun:
    """Return what is proven and measured of a history; of one whose beginning is forgotten, only its steps."""
    contact, states = proven(history).proof(history.problem), states_proven(history)
    steps = ProofOfRun(
        **{field.name: getattr(contact, field.name) for field in fields(Proof)},
        states=states.missed,
        states_unproven=states.unproven,
        pieces=len(history) - history.given,
    )
    if history.forgotten:
        return steps
    load, joints = load_compared(history), slip_joined(history)
    return replace(
        steps,
        load=load.missed,
        compared=load.compared,
        rest=exceeded_at_rest(history),
        slip=joints.slip,
        rate=joints.rate,
    )
