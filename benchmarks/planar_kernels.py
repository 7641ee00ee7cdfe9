"""Plain loops of what a planar slab spends its time on, compiled by numba and by a C compiler, to compare the solver with."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numba
import numpy as np
import scipy.fft
from numpy.typing import NDArray

from stickslip.extensions.planar.memory import horizon, recurrence
from stickslip.extensions.planar.solver import PlanarSolver
from stickslip.friction import LinearSlipWeakening

Floats = NDArray[np.float64]
SOURCE = Path(__file__).parent / "c_kernel" / "exponentials.c"


@numba.njit(fastmath=True)
def exponentials(decay: Floats, gain: Floats, memory: Floats, slip: Floats, sums: Floats) -> None:
    """Advance the memory of a half-space: (wavenumbers, part of the slip, part, poles); real and imaginary parts are apart."""
    for k in range(memory.shape[0]):
        for a in range(2):
            u, total = slip[k, a], 0.0
            for p in range(memory.shape[3]):
                real = decay[k, 0, p] * memory[k, a, 0, p] - decay[k, 1, p] * memory[k, a, 1, p] + gain[k, 0, p] * u
                memory[k, a, 1, p] = decay[k, 0, p] * memory[k, a, 1, p] + decay[k, 1, p] * memory[k, a, 0, p] + gain[k, 1, p] * u
                memory[k, a, 0, p] = real
                total += real
            sums[k, a] = total


def exponentials_in_c() -> Any:
    """Return the same function from C (`cc -O3 -march=native`), with the arguments of `exponentials`; None without a compiler."""
    compiler = shutil.which("cc")
    if compiler is None:
        return None
    target = Path(tempfile.mkdtemp()) / "exponentials.so"
    flags = ("-O3", "-march=native", "-ffast-math", "-fopenmp-simd", "-shared", "-fPIC")
    subprocess.run([compiler, *flags, str(SOURCE), "-o", str(target)], check=True)
    compiled = ctypes.CDLL(str(target)).advance

    def advance(*arrays: Floats) -> None:
        sizes = arrays[2].shape[0], arrays[2].shape[3]
        compiled(*map(ctypes.c_long, sizes), *(array.ctypes.data_as(ctypes.c_void_p) for array in arrays))

    return advance


@numba.njit(fastmath=True)
def convolved(kernel: Floats, history: Floats, n: int, sums: Floats) -> None:
    """Sum kernel[m] history[n - m] over the past, for real and imaginary parts of all wavenumbers."""
    sums[:] = 0.0
    for m in range(n):
        for a in range(2):
            for k in range(kernel.shape[1]):
                sums[a, k] += kernel[m, k] * history[n - m, a, k]


@numba.njit(fastmath=True)
def lines_of_nodes(cosine: Floats, now: Floats, before: Floats) -> None:
    """Take a step of the volume method, within the slab: (nodes through the thickness, real and imaginary part, wavenumbers)."""
    for i in range(1, now.shape[0] - 1):
        for a in range(2):
            for k in range(now.shape[2]):
                before[i, a, k] = cosine[k] * (now[i - 1, a, k] + now[i + 1, a, k]) - before[i, a, k]


@numba.njit(fastmath=True)
def contact(load: Floats, slip: Floats, numbers: tuple[float, ...], rate: Floats) -> None:
    """Solve the contact equation of linear slip weakening at all nodes."""
    impedance, static, dynamic, distance = numbers
    for i in range(load.size):
        strength = static - (static - dynamic) * min(slip[i] / distance, 1.0)
        rate[i] = max(load[i] - strength, 0.0) / impedance


class NumbaSteps:
    """Steps as the solver takes them, before an echo returns, with numba's loops and scipy's Fourier transforms.

    Parameters
    ----------
    run
        A solver of a periodic contact under linear slip weakening, at its start.
    """

    def __init__(self, run: PlanarSolver) -> None:
        self.shape, self.dt, given = run.slab.shape, run.dt, run.constants
        law, normal = run.slab.problem.friction, run.body.normal_stress
        assert isinstance(law, LinearSlipWeakening)
        self.numbers = (run.body.impedance, normal * law.static, normal * law.dynamic, law.distance)
        frequencies = run.layout.wavenumbers(run.slab.spacing).ravel() * run.body.wave_speed
        law_of_waves = recurrence(frequencies, run.body.impedance, run.dt, horizon(run.trips) * run.body.two_way_time)
        apart = [one.T for one in (law_of_waves.decay, law_of_waves.gain)]
        self.decay, self.gain = (np.ascontiguousarray(np.stack([one.real, one.imag], axis=1)) for one in apart)
        self.waves = self.decay.shape[0]
        self.memory = np.zeros((self.waves, 2, 2, self.decay.shape[2]))
        self.now = np.asarray(given.now).ravel()
        self.inherited, self.waves_of_slip = np.zeros((2, self.waves, 2))
        self.waves_of_rate = np.zeros(self.waves, complex)
        self.load, self.slip = np.asarray(given.initial_load).ravel(), np.zeros(int(np.prod(self.shape)))
        self.rate, self.guess = np.zeros((2, self.slip.size))
        contact(self.load, self.slip, self.numbers, self.rate)
        self.waves_of_rate = self._transformed(self.rate)

    def _transformed(self, field: Floats) -> NDArray[np.complex128]:
        return np.asarray(scipy.fft.rfftn(field.reshape(self.shape))).ravel()

    def _move(self, rate: Floats, waves_of_rate: NDArray[np.complex128], found: Floats) -> tuple[Floats, Floats]:
        slip = self.slip + 0.5 * self.dt * (self.rate + rate)
        waves = self.waves_of_slip + 0.5 * self.dt * (self.waves_of_rate + waves_of_rate).view(float).reshape(-1, 2)
        arriving = (self.inherited + self.now[:, None] * waves).view(complex).reshape(*self.shape[:-1], -1)
        load = self.load + scipy.fft.irfftn(arriving, self.shape).ravel()
        contact(load, slip, self.numbers, found)
        return slip, waves

    def advance(self) -> None:
        """Take a step."""
        self._move(self.rate, self.waves_of_rate, self.guess)
        found = np.empty_like(self.rate)
        self.slip, self.waves_of_slip = self._move(self.guess, self._transformed(self.guess), found)
        exponentials(self.decay, self.gain, self.memory, self.waves_of_slip, self.inherited)
        self.rate, self.waves_of_rate = found, self._transformed(found)
