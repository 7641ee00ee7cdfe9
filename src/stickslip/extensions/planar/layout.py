"""How fields on the contact and their wavenumbers are spread over devices, and the Fourier transforms between the two.

Nodes are spread along y. The wavenumbers of a line are spread along k, those of a plane along the wavenumber of z, so that a plane
is transposed by an exchange of all devices with each other; a line, which is small, is gathered. The library does all of this.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.sharding import Mesh, NamedSharding, PartitionSpec
from numpy.typing import NDArray

AXIS = "contact"
"""Name of the axis of devices."""


@dataclass(frozen=True)
class Layout:
    """The contact on a number of devices: all that the process sees, as far as their number divides the nodes along y.

    `shape` has the number of nodes along y, and along z for a plane.
    """

    shape: tuple[int, ...]
    devices: int | None = None

    @cached_property
    def mesh(self) -> Mesh:
        """The devices in use."""
        found = jax.devices()
        count = self.devices or max(d for d in range(1, len(found) + 1) if self.shape[0] % d == 0)
        return Mesh(np.array(found[:count]), (AXIS,))

    @property
    def count(self) -> int:
        """The number of devices in use."""
        return int(self.mesh.size)

    @property
    def half(self) -> int:
        """The number of wavenumbers of the axis on which a real transform is made."""
        return self.shape[-1] // 2 + 1

    @property
    def modes(self) -> tuple[int, ...]:
        """The shape of the wavenumbers, filled up so that the last axis can be spread over the devices."""
        return (*self.shape[:-1], -(-self.half // self.count) * self.count)

    def wavenumbers(self, spacing: tuple[float, ...]) -> NDArray[np.float64]:
        """Return |k| (rad/m) of nodes at these distances (m), of shape `modes`; 0 where wavenumbers are only filled up."""
        last = np.zeros(self.modes[-1])
        last[: self.half] = 2.0 * np.pi * np.fft.rfftfreq(self.shape[-1], spacing[-1])
        if len(self.shape) == 1:
            return last
        first = 2.0 * np.pi * np.fft.fftfreq(self.shape[0], spacing[0])
        return np.where(np.arange(last.size) < self.half, np.hypot(first[:, None], last), 0.0)

    def amplitudes(self, field: Any) -> Any:
        """Return the Fourier amplitudes of a field, real and imaginary parts apart, on the part of this device."""
        if len(self.shape) == 1:
            whole = jax.lax.all_gather(field, AXIS, tiled=True)
            found = self._filled(jnp.fft.rfft(whole))
            size = self.modes[-1] // self.count
            found = jax.lax.dynamic_slice_in_dim(found, jax.lax.axis_index(AXIS) * size, size)
        else:
            found = self._filled(jnp.fft.rfft(field, axis=1))
            found = jnp.fft.fft(jax.lax.all_to_all(found, AXIS, 1, 0, tiled=True), axis=0)
        return jnp.stack([found.real, found.imag])

    def field(self, amplitudes: Any) -> Any:
        """Return the field with these Fourier amplitudes, on the part of this device."""
        found = amplitudes[0] + 1j * amplitudes[1]
        if len(self.shape) == 1:
            whole = jnp.fft.irfft(jax.lax.all_gather(found, AXIS, tiled=True)[: self.half], n=self.shape[0])
            size = self.shape[0] // self.count
            return jax.lax.dynamic_slice_in_dim(whole, jax.lax.axis_index(AXIS) * size, size)
        found = jax.lax.all_to_all(jnp.fft.ifft(found, axis=0), AXIS, 0, 1, tiled=True)
        return jnp.fft.irfft(found[:, : self.half], n=self.shape[1], axis=1)

    def _filled(self, found: Any) -> Any:
        missing = self.modes[-1] - self.half
        return jnp.pad(found, [(0, 0)] * (found.ndim - 1) + [(0, missing)])

    def along_y(self, rank: int) -> PartitionSpec:
        """Return how an array is spread whose last axes are those of the contact and whose rank is given."""
        return PartitionSpec(*[None] * (rank - len(self.shape)), AXIS)

    def along_k(self, rank: int) -> PartitionSpec:
        """Return how an array is spread whose last axes are those of the wavenumbers and whose rank is given."""
        return PartitionSpec(*[None] * (rank - 1), AXIS)

    def put(self, array: Any, spec: PartitionSpec) -> jax.Array:
        """Spread an array that every process holds over the devices."""
        whole = np.asarray(array)
        return jax.make_array_from_callback(whole.shape, NamedSharding(self.mesh, spec), lambda part: whole[part])

    def on_devices(
        self, function: Callable[..., Any], given: Any, returned: Any, donate: tuple[int, ...] = ()
    ) -> Callable[..., Any]:
        """Compile a function of parts of arrays so that it runs on every device, with the library's exchanges between them.

        `given` and `returned` say how arguments and results are spread; arguments in `donate` may be overwritten.
        """
        spread = jax.shard_map(function, mesh=self.mesh, in_specs=given, out_specs=returned, check_vma=False)
        compiled: Callable[..., Any] = jax.jit(spread, donate_argnums=donate)
        return compiled


def whole(array: jax.Array) -> NDArray[Any]:
    """Return an array as numpy's, gathered from all processes if there are several."""
    if array.is_fully_addressable:
        return np.asarray(array)
    from jax.experimental import multihost_utils

    return np.asarray(multihost_utils.process_allgather(array, tiled=True))
