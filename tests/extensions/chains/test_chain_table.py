"""Scenario files with a [chain]: what they say, how they are written, what may be changed in them, and what they give."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.scenarios.parameter_paths import parameter_paths
from stickslip.problem.scenarios.scenario import Scenario, read_scenario

TEXT = """
[friction]
kind = "coulomb"
static = 1.0
dynamic = 0.8
[chain]
blocks = 3
mass = [1.0, "2 kg", 1.0]
coupling = [5.0, "0.01 N/mm"]
stiffness = "1 N/m"
normal_force = { drawn = "uniform", low = "0.9 N", high = "1.1 N", seed = 4 }
pull_rate = "1 mm/s"
damping = "0.1 N s/m"
ends = "free"
[run]
duration = "10 s"
"""
OF_TWO = (1000.0, 1002.122606772294, 1080.660396306022, 1082.781954136647, 1117.329029773771)
"""Changes of the bundled two blocks (s), from issue 72: to 1e-9 of them."""


def _read(text: str = TEXT) -> Scenario:
    return read_scenario(text, "mine.toml")


def test_a_chain_has_the_numbers_of_its_table() -> None:
    chain = _read().to_solve
    assert chain.values("mass").tolist() == [1.0, 2.0, 1.0]
    assert np.asarray(chain.coupling).tolist() == [5.0, 10.0]
    assert (chain.pull_rate, chain.damping, chain.ends, chain.direction) == (1e-3, 0.1, "free", "both")
    drawn = 0.9 + (1.1 - 0.9) * np.random.default_rng(4).random(3)  # numpy's own draw
    assert np.array_equal(chain.values("normal_force"), drawn)


def test_a_scenario_of_a_chain_reads_back_as_it_was_written() -> None:
    scenario = _read()
    text = scenario.to_toml()
    assert "[body]" not in text
    assert "[loading]" not in text
    assert "[initial]" not in text
    assert _read(text) == scenario
    assert _read(text).to_toml() == text


def test_a_lattice_reads_back_as_it_was_written() -> None:
    changed = TEXT.replace("blocks = 3", "blocks = [2, 3]").replace('[1.0, "2 kg", 1.0]', "2.0")
    scenario = _read(changed.replace('[5.0, "0.01 N/mm"]', "[5.0, 7.0]"))
    assert scenario.to_solve.shape == (2, 3)
    assert scenario.to_solve.coupling == (5.0, 7.0)
    assert _read(scenario.to_toml()) == scenario


def test_long_lists_are_read_back_to_the_last_bit() -> None:
    values = np.random.default_rng(3).uniform(0.5, 2.0, 12_000)
    text = TEXT.replace("blocks = 3", "blocks = 12000").replace('[5.0, "0.01 N/mm"]', "5.0")
    scenario = _read(text.replace('[1.0, "2 kg", 1.0]', str(values.tolist())))
    back = _read(scenario.to_toml())
    assert back == scenario
    assert np.array_equal(back.to_solve.values("mass"), values)


def test_each_parameter_changes_the_chain() -> None:
    scenario = _read()
    names = [one.name for one in parameter_paths(scenario) if one.name.startswith("chain.")]
    assert {"chain.mass[1]", "chain.coupling[0]", "chain.normal_force.low", "chain.normal_force.seed"} <= set(names)
    others: dict[str, float | str] = {"chain.ends": "fixed", "chain.direction": "forward", "chain.blocks": 3}
    alone = _read(TEXT.replace('[5.0, "0.01 N/mm"]', "5.0").replace('[1.0, "2 kg", 1.0]', "1.0"))
    for name in names:
        if name == "chain.blocks":
            assert alone.with_values({name: 7}).to_solve.count == 7
            continue
        start = alone if name == "chain.ends" else scenario  # two springs are too few for fixed ends
        changed = start.with_values({name: others.get(name, 7)})
        assert changed.table("chain") != start.table("chain"), name
        assert changed.problem == start.problem


def test_what_a_chain_does_not_have_is_refused_by_name() -> None:
    for name in ("body.mass", "loading.pull_rate", "initial.load"):
        with pytest.raises(ss.InputError, match=r"a scenario with a \[chain\] has no \["):
            _read().with_values({name: 1.0})


def test_the_two_blocks_change_at_the_times_of_the_issue() -> None:
    run = ss.simulate("two-blocks", keep="changes")
    assert run.changes["time"][:5] == pytest.approx(OF_TWO, rel=1e-13)


def test_the_ten_blocks_change_as_in_the_issue() -> None:
    run = ss.simulate("ten-blocks", keep="changes")
    assert run.count_of_changes == 156
    assert run.changes["time"][-1] == pytest.approx(1450.807006456, abs=5e-9)  # to the digits of the issue
    assert run.slip.sum() == pytest.approx(7.291176445, abs=5e-10)


def test_the_starter_runs_and_says_what_its_description_says() -> None:
    run = ss.simulate("chain")
    sizes = run.events["size"]
    assert sizes.min() == 1
    assert sizes.max() > 10


def test_carlson_and_langers_chain_has_events_of_one_block_and_of_all() -> None:
    """No event is smaller than that of one block between neighbours at rest under the jump alone, 2 s/(kp + 2 kc), to 1e-9."""
    run = ss.simulate("carlson-langer")
    assert set(run.events["size"]) >= {1, 100}
    assert run.events["moment"].min() >= 2.0 * 0.01 / (1.0 + 2.0 * 36.0) * (1.0 - 1e-9)
    assert abs(run.energy().error) < 1e-10 * run.energy().heat
