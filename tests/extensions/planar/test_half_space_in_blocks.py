"""The memory of a half-space in machine code: blocks of steps and chunks of waves give what each step alone gives."""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar import half_space
from stickslip.extensions.planar.compiled.half_space import BLOCK
from stickslip.extensions.planar.half_space import InBlocks, StepByStep
from stickslip.extensions.planar.layout import Layout
from stickslip.extensions.planar.memory import recurrence
from stickslip.extensions.planar.solver import PlanarSolver, functions_of, our_settings
from stickslip.foundation.kernels.uncompiled import UNCOMPILED

pytestmark = pytest.mark.skipif(UNCOMPILED, reason="XLA calls machine code alone")


class Followed:
    """A memory on one device that takes steps with slips drawn at random, and keeps what it tells after each."""

    def __init__(self, kind: type[StepByStep], shape: tuple[int, ...]) -> None:
        self.kind = kind(Layout(shape, 1))
        law = recurrence(self.kind.layout.wavenumbers((10.0,) * len(shape)) * 3500.0, 9.8e6, 2e-3, 1.0)
        with our_settings():
            self.numbers = jax.tree.map(jnp.asarray, self.kind.numbers(law))
            self.memory = jax.tree.map(jnp.asarray, self.kind.silent(len(law.decay)))
            self.step = jax.jit(self.kind.advanced)
        self.slips = np.random.default_rng(1).standard_normal((80, 2, *self.kind.layout.modes))

    def told(self, begin: int, end: int) -> list[Any]:
        told = []
        with our_settings():
            for slip in self.slips[begin:end]:
                self.memory, now = self.step(self.memory, self.numbers, slip)
                told.append(np.asarray(now))
        return told

    def saved(self) -> dict[str, Any]:
        with our_settings():
            return self.kind.saved(self.memory, self.numbers)

    def restore(self, state: dict[str, Any]) -> None:
        with our_settings():
            self.memory = jax.tree.map(jnp.asarray, self.kind.restored(state, self.numbers))


def assert_alike(found: list[Any], wanted: list[Any]) -> None:
    assert len(found) == len(wanted) > 0
    for one, other in zip(found, wanted, strict=True):
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-13 * np.abs(other).max())


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("shape", [(30,), (12, 10)])
def test_blocks_of_steps_give_what_each_step_alone_gives(shape: tuple[int, ...]) -> None:
    count = 4 * BLOCK + 3
    assert_alike(Followed(InBlocks, shape).told(0, count), Followed(StepByStep, shape).told(0, count))


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("shape", [(30,), (12, 10)])
@pytest.mark.parametrize("first", [InBlocks, StepByStep])
@pytest.mark.parametrize("then", [InBlocks, StepByStep])
def test_a_memory_goes_on_from_what_another_has_saved(
    shape: tuple[int, ...], first: type[StepByStep], then: type[StepByStep]
) -> None:
    begun, other, middle, end = Followed(first, shape), Followed(then, shape), 2 * BLOCK + 3, 4 * BLOCK + 1
    begun.told(0, middle)
    other.restore(begun.saved())
    found, wanted = other.told(middle, end), begun.told(middle, end)
    assert_alike(found, wanted)
    if first is then:
        np.testing.assert_array_equal(found, wanted)


def test_chunks_of_several_devices_hold_the_waves_of_each_together() -> None:
    layout = Layout((12, 10), 1)
    layout.__dict__["mesh"] = type("Two", (), {"size": 2})()  # as of two devices, which this process has not
    kind = InBlocks(layout)
    rows = np.arange(3.0 * np.prod(layout.modes)).reshape(3, *layout.modes)
    chunks = kind._chunks(rows)
    first = chunks[: len(chunks) // 2].swapaxes(0, 1).reshape(3, -1)[:, : np.prod(layout.modes) // 2]
    np.testing.assert_array_equal(first, rows[..., : layout.modes[-1] // 2].reshape(3, -1))
    np.testing.assert_array_equal(kind._waves(chunks, 1)[:, 0], rows)


@pytest.mark.slow
def test_a_run_is_the_same_where_our_machine_code_cannot_be_called(monkeypatch: pytest.MonkeyPatch) -> None:
    law = ss.friction.LinearSlipWeakening(static=0.7, dynamic=0.5, distance=0.4)
    bump = {"initial.load": lambda y: 60e6 + 11e6 * np.exp(-((y / 4e3) ** 2))}
    problem = ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), law, initial_load=60e6)
    slab = ss.PlanarSlab(problem, nodes=32, length=2e4, along=bump)
    ours = PlanarSolver(slab, 1.2 * slab.body.two_way_time)
    ours.advance(1)
    functions_of.cache_clear()
    monkeypatch.setattr(half_space, "target", lambda: "")
    plain = PlanarSolver(slab, 1.2 * slab.body.two_way_time)
    plain.advance(1)
    functions_of.cache_clear()
    assert type(ours.half_space) is InBlocks
    assert type(plain.half_space) is StepByStep
    while ours.advance(100):
        plain.advance(100)
    found, wanted = ours.now(), plain.now()
    for name in ("slip", "rate", "traction", "heat"):
        other = getattr(wanted, name)
        np.testing.assert_allclose(getattr(found, name), other, rtol=0.0, atol=1e-12 * np.abs(other).max())
    assert np.abs(wanted.slip).max() > 0.0


def test_what_xla_cannot_call_is_done_by_jax(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*given: Any, **more: Any) -> None:
        raise RuntimeError("another interface")

    monkeypatch.setattr(jax.ffi, "register_ffi_target", refuse)
    half_space.target.cache_clear()
    try:
        assert type(half_space.half_space_of(Layout((8,), 1))) is StepByStep
    finally:
        half_space.target.cache_clear()
