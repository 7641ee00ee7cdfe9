"""The table [chain] of scenario files: blocks between springs, in place of [body], [loading] and [initial]."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, Quantity, declare, fields_of, quantity
from stickslip.problem.scenarios import ScenarioTable, read_part, without_owner

if TYPE_CHECKING:
    from stickslip.extensions.chains.chain import Chain
    from stickslip.problem import Problem
    from stickslip.problem.scenarios import Key, Scenario, Source

CHAIN = "chain"
"""The name of the table."""
UNIT = "N"
"""The unit of the loads of a chain."""
UNUSED = {
    "body": {"kind": "spring-block", "mass": 1.0, "stiffness": 1.0, "normal_force": 1.0},
    "loading": {"pull_rate": 0.0},
    "initial": {"load": 0.0},
}
"""What a scenario needs to be read, and a chain has not: nothing is used of it."""
INSTEAD_OF = {
    "body": "[chain] has mass, coupling, stiffness and normal_force",
    "loading": "[chain] has pull_rate",
    "initial": "[chain] has initial_slip",
}
"""What a [chain] has in place of other tables."""


@dataclass(frozen=True)
class GivenChain:
    """What a [chain] says, in SI: numbers of blocks are a number, a tuple of one each, or drawn."""

    blocks: int | tuple[int, int]
    mass: Any
    coupling: Any
    stiffness: Any
    normal_force: Any
    pull_rate: Number = quantity("m/s", "velocity V of the driver")
    damping: Any = 0.0
    initial_slip: Any = 0.0
    ends: str = declare(Choice("ends of the chain", ("free", "fixed", "periodic")), "free")
    direction: str = declare(Choice("directions of slip", ("both", "forward")), "both")


class ChainTable(ScenarioTable):
    """The table [chain]: blocks, what they weigh, the springs between them, and the driver that pulls them."""

    name = CHAIN
    what = "[{}] of blocks"
    instead = "leave out [{}], and give [body] and [loading], for a single block"
    run_keys = frozenset({"duration", "events"})
    in_place_of = frozenset(UNUSED)
    why_no_others = "has no effect with a [chain], whose events are located to rounding"

    @override
    def kind(self) -> type[GivenChain]:
        return GivenChain

    @override
    def other_keys(self) -> Mapping[str, Key]:
        from stickslip.extensions.chains.per_block import of_blocks, read_blocks, read_numbers
        from stickslip.problem.scenarios import Key

        keys = {"blocks": Key(read_blocks, meaning="the number of blocks, or [rows, columns] of a lattice")}
        for name, (declared, default) in of_blocks().items():
            keys[name] = Key(partial(read_numbers, declared), default, f"{declared.described}: one for all, or a list")
        return keys

    @override
    def whole(self) -> frozenset[str]:
        from stickslip.extensions.chains.per_block import SEED_KEY, of_blocks

        return frozenset({"blocks", "blocks[0]", "blocks[1]", *(f"{name}.{SEED_KEY}" for name in of_blocks())})

    @override
    def completed(self, raw: Mapping[str, Any], source: Source) -> Mapping[str, Any]:
        for name, cure in INSTEAD_OF.items():
            if name in raw:
                raise InputError(f"{source.file}: a scenario with a [chain] has no [{name}]: leave it out; {cure}")
        if isinstance(law := raw.get("friction"), dict):
            _check_law(law, source)
        return UNUSED | dict(raw)

    @override
    def read(self, entries: Mapping[str, Any], problem: Problem, source: Source) -> GivenChain:
        found = GivenChain(**entries)
        try:
            chain_of(found, problem)
        except InputError as error:
            raise InputError(f"{source.file}: [chain] {without_owner(error)}") from None
        return found

    @override
    def write(self, value: GivenChain) -> dict[str, Any]:
        from stickslip.extensions.chains.per_block import written

        return {name: written(one) for name, one in vars(value).items()}

    @override
    def paths(self, value: GivenChain, problem: Problem) -> Iterator[tuple[str, Quantity | Choice]]:
        from stickslip.extensions.chains.per_block import COUNT_OF_BLOCKS, numbers_in, of_blocks

        yield from (
            (name, COUNT_OF_BLOCKS) for name in (("blocks",) if isinstance(value.blocks, int) else ("blocks[0]", "blocks[1]"))
        )
        for name, (declared, _) in of_blocks().items():
            yield from numbers_in(name, declared, getattr(value, name))
        yield from ((name, entry) for name, (entry, _) in fields_of(GivenChain).items() if isinstance(entry, Quantity | Choice))

    @override
    def pressed(self, value: GivenChain, factor: float) -> GivenChain:
        raise InputError("pressing changes a body's loads: with a [chain], change chain.normal_force")

    @override
    def problem(self, value: GivenChain, scenario: Scenario) -> Chain:
        return chain_of(value, scenario.problem)


def _check_law(law: dict[str, Any], source: Source) -> None:
    """Refuse a law that no chain has, before a start is sought for it. Raises InputError."""
    from stickslip.extensions.chains.chain import check_law

    found = read_part("friction", dict(law), source._replace(load_unit=UNIT))
    try:
        check_law(found)
    except InputError as error:
        raise InputError(f"{source.file}: [friction] {str(error).removeprefix('Chain: friction: ')}") from None


def chain_of(value: GivenChain, problem: Problem) -> Chain:
    """Return the chain of a [chain], with the law of a problem for all blocks. Raises InputError as `Chain` does."""
    from stickslip.extensions.chains.chain import Chain

    return Chain(problem.friction, **vars(value))


def given_of(chain: Chain) -> GivenChain:
    """Return what a [chain] says of a chain. Raises InputError for one that no scenario file can say."""
    from stickslip.extensions.chains.per_block import as_given, of_blocks

    numbers = {name: as_given(name, getattr(chain, name)) for name in of_blocks()}
    return GivenChain(chain.blocks, pull_rate=chain.pull_rate, ends=chain.ends, direction=chain.direction, **numbers)
