"""Which laws have a slip memory, and where it may be chosen."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import pytest

from stickslip import InputError
from stickslip.friction import LAWS, Coulomb, FromExpression, FromFunction, FromTable, LinearSlipWeakening, SinusoidalSlip
from stickslip.scenarios.scenario import read_scenario
from stickslip.scenarios.templates import template

CHOICE = '# memory = "all"'


@pytest.mark.parametrize("kind", LAWS)
def test_exactly_the_laws_of_slip_offer_a_memory(kind: str) -> None:
    text = template("slab", kind)
    law = read_scenario(text, "new").problem.friction
    assert law.memory == "all"
    offered = "memory" in {field.name for field in fields(law)}
    assert offered == (text.count(CHOICE) == 1 and f'[friction]\nkind = "{kind}"' in text and kind not in ("sum", "product"))
    if kind in ("expression", "sum", "product"):
        return  # the example of an expression has no u; a sum or product has the memory of its slip law
    assert offered == law.depends_on_slip
    if offered:
        healing = read_scenario(text.replace(CHOICE, 'memory = "since-arrest"'), "new")
        assert healing.problem.friction.memory == "since-arrest"
        assert read_scenario(healing.to_toml(), "again").problem == healing.problem


@pytest.mark.parametrize("kind", ["sum", "product"])
def test_a_part_of_a_composite_decides(kind: str) -> None:
    text = template("slab", kind).replace(CHOICE, 'memory = "since-arrest"')
    assert read_scenario(text, "new").problem.friction.memory == "since-arrest"
    assert LAWS["sum"](SinusoidalSlip(0.6, 0.1, 5.0, memory="since-arrest"), Coulomb(0.1, 0.0)).memory == "since-arrest"


def test_memory_cannot_be_given_by_position() -> None:
    assert SinusoidalSlip(1.0, 0.5, 5.0) == SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=5.0, memory="all")
    with pytest.raises(TypeError, match="positional"):
        LinearSlipWeakening(0.6, 0.3, 0.1, "since-arrest")  # type: ignore[misc]


def test_what_users_bring_may_heal() -> None:
    made: list[Any] = [
        FromExpression("0.6 - 0.1*tanh(u)", memory="since-arrest"),
        FromFunction(lambda u, v: 0.6 - 0.1 * u / (1.0 + u * u), memory="since-arrest"),
        FromTable(slip=[0.0, 1.0], friction=[0.6, 0.5], memory="since-arrest"),
    ]
    assert [law.memory for law in made] == ["since-arrest"] * 3


REFUSED = {
    "table of rates": lambda: FromTable(rate=[0.0, 1.0], friction=[0.6, 0.5], memory="since-arrest"),
    "expression in v": lambda: FromExpression("0.6 - 0.1*tanh(v)", memory="since-arrest"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_laws_that_do_not_depend_on_slip_refuse_to_forget(name: str) -> None:
    with pytest.raises(InputError, match=r"^\w+: memory 'since-arrest' needs friction that depends on slip; allowed here: all$"):
        REFUSED[name]()


def test_unknown_memories_are_refused() -> None:
    with pytest.raises(InputError, match=r"^LinearSlipWeakening: memory 'since arrest' is unknown; did you mean 'since-arrest'\?$"):
        LinearSlipWeakening(0.6, 0.3, 0.1, memory="since arrest")  # type: ignore[arg-type]
    text = template("slab", "linear-slip-weakening").replace(CHOICE, 'memory = "none"')
    with pytest.raises(InputError, match=r"^new: \[friction\] memory 'none' is unknown; "):
        read_scenario(text, "new")
    text = template("slab", "hyperbolic-rate").replace('kind = "hyperbolic-rate"', 'kind = "hyperbolic-rate"\nmemory = "all"')
    with pytest.raises(InputError, match=r"^new: \[friction\] memory is unknown"):
        read_scenario(text, "new")
