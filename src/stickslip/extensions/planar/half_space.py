"""How the memory of a half-space is kept and advanced: in blocks of steps by our machine code on a processor, elsewhere by JAX.

Both have the same numbers to rounding, and what is saved of one is read by the other.
"""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import CFUNCTYPE, c_void_p
from functools import cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax.sharding import PartitionSpec
from numpy.typing import NDArray

from stickslip.extensions.planar.compiled.half_space import BLOCK, advance
from stickslip.extensions.planar.layout import AXIS, Layout, whole
from stickslip.extensions.planar.memory import MemoryRecurrence, advanced
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.code import kept_of
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH
from stickslip.foundation.kernels.uncompiled import UNCOMPILED

ANYWHERE = PartitionSpec()
SAVED = ("exponentials", "ahead", "recent", "since")
"""What is saved of a memory: M, what it tells at the steps of its block, slip at those that have passed, and their number."""


class HalfSpaceNumbers(NamedTuple):
    """What does not change in a run: d, g and K of `compiled.half_space`."""

    decay: Any
    gain: Any
    near: Any


class HalfSpaceMemory(NamedTuple):
    """What waves in a half-space remember of slip: see `SAVED`."""

    exponentials: Any
    ahead: Any
    recent: Any
    since: Any


class StepByStep:
    """The memory in JAX, on any device: each exponential takes each step."""

    def __init__(self, layout: Layout) -> None:
        self.layout = layout
        rank = len(layout.shape)
        paths = layout.along_k(rank + 2)
        self.numbers_lie = HalfSpaceNumbers(paths, paths, ANYWHERE)
        self.memory_lies = HalfSpaceMemory(paths, ANYWHERE, ANYWHERE, ANYWHERE)

    def numbers(self, law: MemoryRecurrence) -> HalfSpaceNumbers:
        """Return the numbers of a recurrence."""
        return HalfSpaceNumbers(law.decay[:, None], law.gain[:, None], np.zeros(0))

    def silent(self, count: int) -> HalfSpaceMemory:
        """Return the memory of a contact that has not slipped, with a number of exponentials."""
        none = np.zeros(0)
        return HalfSpaceMemory(np.zeros((count, 2, *self.layout.modes), complex), none, none, np.int64(0))

    def advanced(self, memory: HalfSpaceMemory, numbers: HalfSpaceNumbers, slip: Any) -> tuple[HalfSpaceMemory, Any]:
        """Return the memory after a step that ends with the amplitudes of a slip (m), and its part of F (Pa) from then on."""
        exponentials, inherited = advanced(memory.exponentials, numbers.decay, numbers.gain, slip)
        return memory._replace(exponentials=exponentials), inherited

    def saved(self, memory: HalfSpaceMemory, numbers: HalfSpaceNumbers) -> dict[str, NDArray[Any]]:
        """Return what a run continues from, on any devices: see `SAVED`; M has its real and imaginary parts in front."""
        now, decay = whole(memory.exponentials), whole(numbers.decay)
        ahead = np.stack([(decay**j * now).real.sum(axis=0) for j in range(BLOCK)])
        return self._named(np.stack([now.real, now.imag]), ahead, np.zeros_like(ahead), np.asarray(0))

    def restored(self, state: Mapping[str, NDArray[Any]], numbers: HalfSpaceNumbers) -> HalfSpaceMemory:
        """Return a memory that was saved, whose wavenumbers have been filled up."""
        now, (decay, gain) = state["exponentials"][0] + 1j * state["exponentials"][1], map(whole, numbers[:2])
        for slip in state["recent"][: int(state["since"])]:
            now, _ = advanced(now, decay, gain, slip)
        return self.silent(0)._replace(exponentials=now)

    def _named(self, *arrays: NDArray[Any]) -> dict[str, NDArray[Any]]:
        """Return what is saved without wavenumbers that are only filled up."""
        return {name: one[..., : self.layout.half] if one.ndim else one for name, one in zip(SAVED, arrays, strict=True)}


class InBlocks(StepByStep):
    """The memory in machine code that JAX calls on the arrays of each part of a processor: blocks of steps, chunks of waves."""

    def __init__(self, layout: Layout) -> None:
        super().__init__(layout)
        chunks = PartitionSpec(AXIS)
        self.numbers_lie = HalfSpaceNumbers(chunks, chunks, chunks)
        self.memory_lies = HalfSpaceMemory(chunks, chunks, chunks, ANYWHERE)

    def numbers(self, law: MemoryRecurrence) -> HalfSpaceNumbers:
        """Return the numbers of a recurrence."""
        near, power = [], law.gain
        for _ in range(BLOCK):
            near.append(power.real.sum(axis=0))
            power = power * law.decay
        parts = (np.stack([one.real, one.imag], axis=1) for one in (law.decay, law.gain))
        return HalfSpaceNumbers(*(self._chunks(one) for one in (*parts, np.stack(near))))

    def silent(self, count: int) -> HalfSpaceMemory:
        """Return the memory of a contact that has not slipped, with a number of exponentials."""
        chunks = self.layout.count * (self._chunked + self._missing) // SIMD_WIDTH
        exponentials, ahead, recent = (np.zeros((chunks, n, SIMD_WIDTH)) for n in (4 * count, 2 * BLOCK, 2 * BLOCK))
        return HalfSpaceMemory(exponentials, ahead, recent, np.int64(0))

    def advanced(self, memory: HalfSpaceMemory, numbers: HalfSpaceNumbers, slip: Any) -> tuple[HalfSpaceMemory, Any]:
        """Return the memory after a step that ends with the amplitudes of a slip (m), and its part of F (Pa) from then on."""
        filled = jnp.pad(slip.reshape(2, -1), ((0, 0), (0, self._missing))).reshape(2, -1, SIMD_WIDTH)
        alike = [jax.ShapeDtypeStruct(one.shape, one.dtype) for one in (*memory, filled)]
        call = jax.ffi.ffi_call(target(), alike, input_output_aliases={0: 0, 1: 1, 2: 2, 6: 3})
        *found, told = call(*memory[:3], *numbers, memory.since, filled)
        return HalfSpaceMemory(*found), told.reshape(2, -1)[:, : self._chunked].reshape(slip.shape)

    def saved(self, memory: HalfSpaceMemory, numbers: HalfSpaceNumbers) -> dict[str, NDArray[Any]]:
        """Return what a run continues from, on any devices: see `SAVED`; M has its real and imaginary parts in front."""
        exponentials, ahead, recent = (self._waves(whole(one), 2) for one in memory[:3])
        parts = exponentials.reshape(-1, 2, *exponentials.shape[1:])  # (poles, part of slip, part of M, wavenumbers)
        return self._named(np.moveaxis(parts, 2, 0), ahead, recent, whole(memory.since))

    def restored(self, state: Mapping[str, NDArray[Any]], numbers: HalfSpaceNumbers) -> HalfSpaceMemory:
        """Return a memory that was saved, whose wavenumbers have been filled up."""
        parts = np.moveaxis(state["exponentials"], 0, 2)
        return HalfSpaceMemory(self._chunks(parts), self._chunks(state["ahead"]), self._chunks(state["recent"]), state["since"])

    @property
    def _chunked(self) -> int:
        """The number of wavenumbers of each device."""
        return int(np.prod(self.layout.modes)) // self.layout.count

    @property
    def _missing(self) -> int:
        """By how many wavenumbers those of a device are filled up to whole chunks."""
        return -self._chunked % SIMD_WIDTH

    def _chunks(self, rows: Floats) -> Floats:
        """Return numbers of all wavenumbers, rows of any axes, as (chunks, rows, lanes); those of each device lie together."""
        modes = self.layout.modes
        flat = rows.reshape(-1, *modes[:-1], self.layout.count, modes[-1] // self.layout.count)
        flat = np.moveaxis(flat, -2, 0).reshape(self.layout.count, len(flat), -1)
        flat = np.pad(flat, ((0, 0), (0, 0), (0, self._missing))).reshape(*flat.shape[:2], -1, SIMD_WIDTH)
        return np.ascontiguousarray(np.swapaxes(flat, 1, 2)).reshape(-1, flat.shape[1], SIMD_WIDTH)

    def _waves(self, chunks: Floats, parts: int) -> Floats:
        """Return rows of wavenumbers from (chunks, rows, lanes), as (rows / parts, parts, *wavenumbers)."""
        modes, count = self.layout.modes, self.layout.count
        flat = np.swapaxes(chunks.reshape(count, -1, *chunks.shape[1:]), 1, 2)
        flat = flat.reshape(*flat.shape[:2], -1)[..., : self._chunked]
        flat = flat.reshape(count, -1, parts, *modes[:-1], modes[-1] // count)
        return np.moveaxis(flat, 0, -2).reshape(-1, parts, *modes)


@cache
def target() -> str:
    """Return the name of our machine code in XLA, or nothing if XLA cannot call it.

    The name holds the key of the code, because JAX keeps what it has compiled with calls of it.
    """
    if UNCOMPILED:
        return ""
    code: Any = advance
    name = f"stickslip.{kept_of(code).file}"
    try:
        jax.ffi.register_ffi_target(name, jax.ffi.pycapsule(CFUNCTYPE(c_void_p, c_void_p)(code.address)), platform="cpu")
    except (InputError, RuntimeError, ValueError, AttributeError):  # there is no compiler, or JAX has another interface
        return ""
    return name


def half_space_of(layout: Layout) -> StepByStep:
    """Return how the memory is advanced on the devices of a layout."""
    on_processors = all(device.platform == "cpu" for device in layout.mesh.devices.flat)
    return InBlocks(layout) if on_processors and target() else StepByStep(layout)
