"""The table [contact] of scenario files: a slab whose slip varies along its contact is then what is solved."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, Quantity
from stickslip.problem.scenarios import ScenarioTable

if TYPE_CHECKING:
    from stickslip.extensions.planar.contact import Contact
    from stickslip.extensions.planar.slab import PlanarSlab
    from stickslip.problem import Problem
    from stickslip.problem.scenarios import Key, Scenario, Source

CONTACT = "contact"
"""The name of the table."""


class ContactTable(ScenarioTable):
    """The table [contact]: a grid along the contact, and what varies along it."""

    name = CONTACT
    what = "[{}] of many nodes"
    instead = "leave out [{}] for the problem in 1D that each node has"
    run_keys = frozenset({"duration"})
    why_no_others = "has no effect with a [contact], whose nodes and courant set the accuracy"

    @override
    def kind(self) -> type[Contact]:
        from stickslip.extensions.planar.contact import Contact

        return Contact

    @override
    def other_keys(self) -> Mapping[str, Key]:
        from stickslip.problem.scenarios import Key, read_as

        return {
            "replicas": Key(partial(read_as, bool, "true or false"), True),
            "along": Key(partial(read_as, dict, "a table of what varies along the contact"), MappingProxyType({})),
            "patches": Key(partial(read_as, list, "tables, each after a line [[contact.patches]]"), ()),
        }

    @override
    def read(self, entries: Mapping[str, Any], problem: Problem, source: Source) -> Contact:
        from stickslip.extensions.planar.contact_table import read_contact

        contact = read_contact(entries, problem, source.file)
        nodes = contact.nodes * (contact.width_nodes or 1)
        if nodes > source.most_nodes:
            raise InputError(
                f"{source.file}: [contact] has {nodes} nodes, {source.most_nodes:g} are the most that can be used here"
            )
        return contact

    @override
    def write(self, value: Contact) -> dict[str, Any]:
        from stickslip.extensions.planar.contact_table import contact_table

        return contact_table(value)

    @override
    def paths(self, value: Contact, problem: Problem) -> Iterator[tuple[str, Quantity | Choice]]:
        from stickslip.extensions.planar.contact import LOCKED
        from stickslip.extensions.planar.contact_table import INTERVALS_OF_AXES, TAPER
        from stickslip.extensions.planar.nodes import varying
        from stickslip.problem.scenarios import YES_OR_NO

        yield from super().paths(value, problem)
        yield "replicas", YES_OR_NO
        units = {name: declared for name, (declared, _) in varying(problem).items()}
        for i, patch in enumerate(value.patches):
            place, values = f"patches[{i}]", [name for name, _ in patch.values if name != LOCKED]
            for axis, declared in INTERVALS_OF_AXES.items():
                yield from ((f"{place}.{axis}[{j}]", declared) for j in range(len(getattr(patch, axis) or ())))
            yield from ((f"{place}.{name}", units[name]) for name in values)
            if values:
                yield f"{place}.taper", TAPER

    @override
    def pressed(self, value: Contact, factor: float) -> Contact:
        return value.pressed(factor)

    @override
    def problem(self, value: Contact, scenario: Scenario) -> PlanarSlab:
        return value.slab(scenario.problem)

    @override
    def check(self, value: Contact, scenario: Scenario, source: Source) -> None:
        from stickslip.problem.scenarios import without_owner

        try:
            _ = planar_slab_of(scenario).steps(scenario.duration)
        except InputError as error:
            raise InputError(f"{source.file}: [contact] {without_owner(error)}") from None


def contact_of(scenario: Scenario) -> Contact:
    """Return the [contact] of a scenario. Raises InputError if it has none."""
    found: Contact | None = scenario.table(CONTACT)
    if found is None:
        raise InputError(f"{scenario.name}: has no [contact] of many nodes: take its .problem")
    return found


def planar_slab_of(scenario: Scenario) -> PlanarSlab:
    """Return the slab with the [contact] of a scenario. Raises InputError if it has none, or as `PlanarSlab` does."""
    contact_of(scenario)
    found: PlanarSlab = scenario.to_solve
    return found
