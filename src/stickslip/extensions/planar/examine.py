"""Examine a scenario with a contact of many nodes without running it: sizes, steps, what slips at once, what is resolved."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from stickslip.extensions.planar.contact import LOCKED, Contact, Patch, PointsAlong
from stickslip.extensions.planar.nodes import varying
from stickslip.extensions.planar.slab import ENOUGH_NODES, PlanarSlab
from stickslip.extensions.planar.summary import size_of
from stickslip.extensions.planar.table import CONTACT, contact_of, planar_slab_of
from stickslip.foundation.quantities import quantities_of
from stickslip.foundation.show import brief
from stickslip.problem import loading_rate
from stickslip.problem.scenarios import Scenario, doubts
from stickslip.run.check import LARGE_STRAIN, Examination, Fact
from stickslip.run.check.examine import examine


def examine_contact(scenario: Scenario) -> Examination:
    """Examine a scenario with a contact of many nodes.

    Given and derived numbers, stability and uniqueness are those of a node where no patch and no profile gives others.
    """
    slab, contact, found = planar_slab_of(scenario), contact_of(scenario), examine(scenario.with_table(CONTACT, None))
    run = [fact for fact in found.given["run"] if fact.name == "duration"]
    return replace(
        found,
        given=found.given | {"run": run, "contact": list(_given(contact, slab))},
        derived=[*found.derived, *_derived(slab, scenario.duration), Fact("memory", size_of(scenario), "", "of a run")],
        start=_start(slab),
        critical=[],
        along_slip="",
        warnings=list(_warnings(slab, scenario.duration)),
    )


def _given(contact: Contact, slab: PlanarSlab) -> Iterator[Fact]:
    for name, declared in quantities_of(Contact).items():
        if (value := getattr(contact, name)) is not None:
            yield Fact(name, value, declared.unit, declared.meaning)
    yield Fact("replicas", "yes" if contact.replicas else "no", "", "the contact repeats itself, or is alone")
    units = {name: declared.unit for name, (declared, _) in varying(slab.problem).items()} | {LOCKED: ""}
    for name, given in contact.along:
        values = np.asarray(given.values if isinstance(given, PointsAlong) else given, float)
        ends = f"from {brief(values.min(), units[name])} to {brief(values.max(), units[name])}"
        yield Fact(f"along.{name}", f"{values.size} {'points' if isinstance(given, PointsAlong) else 'values'}", "", ends)
    for i, patch in enumerate(contact.patches):
        shown = [f"{name} = {brief(one, units[name]) if name != LOCKED else str(one).lower()}" for name, one in patch.values]
        yield Fact(f"patches[{i}]", ", ".join(shown), "", _place(patch))


def _place(patch: Patch) -> str:
    """Return where a patch is, in words."""
    sides = [f"{axis} from {brief(one[0], 'm')} to {brief(one[1], 'm')}" for axis, one in (("y", patch.y), ("z", patch.z)) if one]
    words = ["outside" * patch.outside, f"the {patch.shape}" * (len(sides) == 2), " and ".join(sides)]
    return " ".join(word for word in words if word) + f", taper {brief(patch.taper, 'm')}" * (patch.taper > 0.0)


def _derived(slab: PlanarSlab, duration: float) -> Iterator[Fact]:
    step = slab.body.two_way_time / slab.steps_per_round_trip
    yield Fact("time step", step, "s", f"{slab.steps(duration)} steps, {slab.steps_per_round_trip} in R")
    for axis, distance in zip("yz", slab.spacing, strict=False):
        yield Fact(f"d{axis}", distance, "m", f"distance of nodes along {axis}")
    nodes = slab.nodes_per_process_zone(slab.reach)
    if math.isfinite(nodes):
        yield Fact("process zone", nodes, "1", "nodes behind the tip of a slow front, where friction falls; fast fronts have fewer")


def _start(slab: PlanarSlab) -> str:
    free, count = ~slab.locked, slab.locked.size
    locked = f", {int(slab.locked.sum())} are locked" if slab.locked.any() else ""
    if not slab.problem.friction.sticks:
        return f"{int(free.sum())} of {count} nodes creep from the start: friction with a state of its own never sticks{locked}"
    excess = slab.values.excess[free]
    slips = int((excess > 0.0).sum())
    below = excess[excess <= 0.0]
    rest = f"; the others are {brief(abs(below.max()), 'Pa')} or more below their strength" if below.size else ""
    return f"{slips} of {count} nodes slip at once{locked}{rest}"


def _warnings(slab: PlanarSlab, duration: float) -> Iterator[str]:
    """Yield what a user should know before trusting a run."""
    problems = slab.values.problems
    extremes = max(problems, key=lambda one: one.strength / one.normal), min(problems, key=lambda one: one.normal)
    yield from dict.fromkeys(line for problem in extremes for line in doubts(problem))
    if slab.locked.all():
        yield "every node is locked: nothing will slip"
    elif slab.problem.friction.sticks and not slab.problem.varies and (excess := slab.values.excess[~slab.locked].max()) <= 0.0:
        rate = loading_rate(slab.problem)
        if rate <= 0.0 or -excess / rate > duration:
            yield "no node is loaded to its strength before the run ends: nothing will slip"
    strain = float(np.abs(slab.values.load).max()) / slab.body.shear_modulus
    if strain > LARGE_STRAIN:
        yield f"the shear strain at the start is {strain:.3g}: linear elasticity is doubtful beyond {LARGE_STRAIN:g}"
    nodes = slab.nodes_per_process_zone(slab.reach)
    if nodes < ENOUGH_NODES:
        wanted = 2 * math.ceil(slab.nodes * ENOUGH_NODES / nodes / 2.0)
        yield f"the process zone has {nodes:.3g} nodes, not resolved: {ENOUGH_NODES:g} are wanted, as with {wanted} nodes along y"
    if duration < slab.body.two_way_time:
        yield f"the run ends before the first echo returns at R = {slab.body.two_way_time:.6g} s"
    if slab.replicas and (len(problems) > 1 or slab.locked.any()):
        apart = " and ".join(brief(size, "m") for size in slab.extent)
        yield f"the contact repeats itself every {apart}, and waves of its replicas arrive: replicas = false keeps them away"
