"""March a planar slab in time: step by step (`step.py`), with echoes round trip by round trip.

Everything reaches the contact as a load: Z v + tau = beta(y, t) at every node (paper eqs 12-13), with

    beta = initial load + loading + F + P,

F from the memory of the half-space (`memory.py`), P from the driver (`echo.py`), and the loading as in 1D, because it is the same
at all nodes. The error is of order 2 in the time step where the motion is smooth, and of order 1 where nodes begin or end to slip.

Contacts that differ in numbers only share what is compiled (`functions_of`), so that a second run begins at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import jax
import numpy as np
from jax.sharding import PartitionSpec
from numpy.typing import NDArray

from stickslip.extensions.planar.compiled_before import COMPILED_BEFORE
from stickslip.extensions.planar.driving import locked_load
from stickslip.extensions.planar.echo import Echo, echo_of, echo_weights, kernel_spectra, silent
from stickslip.extensions.planar.friction import ContactOfNodes, Nodes
from stickslip.extensions.planar.half_space import SAVED, StepByStep, half_space_of
from stickslip.extensions.planar.layout import Layout, whole
from stickslip.extensions.planar.memory import horizon, recurrence
from stickslip.extensions.planar.slab import PlanarSlab
from stickslip.extensions.planar.step import Constants, PlanarMotion, PlanarStep, PlanarWaves
from stickslip.foundation.arrays import Floats

ALIKE = PartitionSpec()
"""How an array is spread that every device holds."""


class Spread(NamedTuple):
    """How the arrays of a run are spread over devices."""

    motion: PlanarMotion
    waves: PlanarWaves
    echo: Echo
    constants: Constants
    spectra: PartitionSpec

    @classmethod
    def of(cls, layout: Layout, parameters: tuple[str, ...], half_space: StepByStep) -> Spread:
        """Return how they are spread for a law with parameters of these names."""
        rank = len(layout.shape)
        y, more = layout.along_y(rank), layout.along_y(rank + 1)
        k, paths, histories = (layout.along_k(rank + extra) for extra in (1, 2, 3))
        nodes = Nodes(y, y, more, dict.fromkeys(parameters, more), y, ALIKE)
        return cls(
            motion=PlanarMotion(y, y, y, y, more, y, y),
            waves=PlanarWaves(half_space.memory_lies, k, k, k, k, paths, paths),
            echo=Echo(histories, paths, paths, ALIKE, k),
            constants=Constants(nodes, y, half_space.numbers_lie, layout.along_k(rank), ALIKE),
            spectra=histories,
        )


class Compiled(NamedTuple):
    """The functions of a run on all devices."""

    march: Callable[..., Any]
    """Take the steps between two numbers of a round trip."""
    open: Callable[..., Any]
    """Find the motion just after a round trip has begun, when its echo has arrived."""
    turn: Callable[..., Any]
    """Turn what was sent in a round trip into what arrives in the next."""


MOST_FORMS = 16
"""Keep this many compiled forms of runs at a time; each takes some 7 MB."""


@lru_cache(maxsize=MOST_FORMS)
def functions_of(contact: ContactOfNodes, layout: Layout, parameters: tuple[str, ...]) -> Compiled:
    """Return the functions of runs with these formulas, this number of nodes and these names of parameters.

    JAX keeps what it has compiled of functions that are gone, so all is forgotten when there are too many forms. A run that goes on
    is then compiled once more.
    """
    if functions_of.cache_info().currsize >= MOST_FORMS:
        functions_of.cache_clear()
        jax.clear_caches()
    half_space = half_space_of(layout)
    step, spread = PlanarStep(contact, layout, half_space), Spread.of(layout, parameters, half_space)

    def march(motion: PlanarMotion, waves: PlanarWaves, constants: Constants, loading: Any, between: Any) -> Any:
        def one(number: Any, now: tuple[PlanarMotion, PlanarWaves]) -> tuple[PlanarMotion, PlanarWaves]:
            return step.taken(now, constants, loading[number + 1], number + 1)

        return jax.lax.fori_loop(between[0], between[1], one, (motion, waves))

    def turn(sent: Any, echo: Echo, spectra: Any, reflection: Any) -> tuple[Any, Echo]:
        return echo_of(sent, echo, spectra, reflection)

    now, sent = (spread.motion, spread.waves), spread.waves.sent
    return Compiled(
        layout.on_devices(march, (*now, spread.constants, ALIKE, ALIKE), now, donate=(0, 1)),
        layout.on_devices(step.opened, (*now, spread.constants, ALIKE), now, donate=(0, 1)),
        layout.on_devices(turn, (sent, spread.echo, spread.spectra, ALIKE), (sent, spread.echo), donate=(1,)),
    )


@dataclass(eq=False)
class PlanarSolver:
    """A run of a planar slab in progress, which may go up to a duration (s), on a number of devices (None for all).

    The number of time steps in a two-way travel time is the smallest that keeps to the slab's `courant` if it is None.
    """

    slab: PlanarSlab
    duration: float
    steps_per_round_trip: int | None = None
    devices: int | None = None
    motion: PlanarMotion = field(init=False)
    waves: PlanarWaves = field(init=False)
    echo: Echo = field(init=False)
    trip: int = field(init=False, default=0)
    """Number of whole round trips that have passed."""
    step: int = field(init=False, default=0)
    """Number of steps since the round trip began."""

    def __post_init__(self) -> None:
        self.steps = self.steps_per_round_trip or self.slab.steps_per_round_trip
        self.body = body = self.slab.body
        self.dt = body.two_way_time / self.steps
        self.trips = self.slab.round_trips(self.duration)
        self.layout, parameters = Layout(self.slab.shape, self.devices), tuple(self.slab.values.numbers[0])
        self.half_space = half_space_of(self.layout)
        self.spread = Spread.of(self.layout, parameters, self.half_space)
        self.functions = functions_of(ContactOfNodes.of(self.slab.values.law), self.layout, parameters)
        with our_settings():
            self._begin()

    @property
    def time(self) -> float:
        """The simulated time, s."""
        return float(self.trip * self.body.two_way_time + self.step * self.dt)

    @property
    def last_step(self) -> int:
        """The number of steps in the whole run."""
        return min(int(np.ceil(self.duration / self.dt - 1e-9)), self.trips * self.steps)

    @property
    def steps_left(self) -> int:
        """The number of steps up to the end of the run."""
        return max(0, self.last_step - self.trip * self.steps - self.step)

    @property
    def is_shared(self) -> bool:
        """True if several processes share the run: all of them must then ask for the same steps, whatever time these take."""
        return int(jax.process_count()) > 1

    @cached_property
    def loading(self) -> Floats:
        """Load of a contact that never slips, minus the initial load, at the steps of each round trip (Pa)."""
        return locked_load(self.slab.problem, self.steps, self.trips)

    # ---- the start ---------------------------------------------------------------------------------------------------------------

    def _begin(self) -> None:
        layout, values = self.layout, self.slab.values
        frequencies = layout.wavenumbers(self.slab.spacing) * self.body.wave_speed
        law_of_waves = recurrence(frequencies, self.body.impedance, self.dt, horizon(self.trips) * self.body.two_way_time)
        nodes = Nodes.of(values, self.slab.locked, self.body.impedance)
        numbers = self.half_space.numbers(law_of_waves)
        constants = Constants(nodes, values.load, numbers, law_of_waves.now, np.float64(self.dt))
        self.constants = self._put(constants, self.spread.constants)
        none, amplitudes = np.zeros(self.slab.shape), (2, *layout.modes)
        path = np.zeros((self.steps + 1, *amplitudes))
        memory = self.half_space.silent(len(law_of_waves.decay))
        self.motion = self._put(
            PlanarMotion(values.slip, none, values.load, values.law_slip, values.states, none, none), self.spread.motion
        )
        self.waves = self._put(PlanarWaves(memory, *(path[0],) * 4, path, path), self.spread.waves)
        self.echo = self._put(silent(self.trips - 1, self.steps, amplitudes), self.spread.echo)
        self.spectra = layout.put(self._spectra(frequencies), self.spread.spectra)
        self._open_round_trip()

    def _spectra(self, frequencies: Floats) -> NDArray[np.complex128]:
        """Return the Fourier transforms of the weights of echoes, for all round trips after the first."""
        unique, which = np.unique(frequencies.round(9), return_inverse=True)
        count = (self.trips - 1) * self.steps
        weights = echo_weights(unique, self.steps, self.body.two_way_time, count)
        if not count:
            return np.zeros((0, 2, self.steps + 1, *frequencies.shape), complex)
        return kernel_spectra(weights, self.steps, np.reshape(which, frequencies.shape))

    def _put(self, arrays: Any, specs: Any) -> Any:
        return jax.tree.map(self.layout.put, arrays, specs, is_leaf=lambda one: isinstance(one, np.ndarray | np.generic))

    # ---- the run -----------------------------------------------------------------------------------------------------------------

    def advance(self, count: int) -> int:
        """Take at most `count` steps, no further than the end of the round trip or of the run; return how many were taken.

        Returns when they have been computed.
        """
        if not self.steps_left:
            return 0
        with our_settings():
            if self.step == self.steps:
                self.waves = self.waves._replace(arriving=self._turn(self.waves.sent))
                self.trip, self.step = self.trip + 1, 0
                self._open_round_trip()
            taken = min(count, self.steps - self.step, self.steps_left)
            loading, between = self.loading[self.trip], np.array([self.step, self.step + taken])
            self.motion, self.waves = jax.block_until_ready(
                self.functions.march(self.motion, self.waves, self.constants, loading, between)
            )
            self.step += taken
            return taken

    def _turn(self, sent: Any) -> Any:
        """Return what this round trip sends to the next one, and keep the echoes for those after it."""
        arriving, self.echo = self.functions.turn(sent, self.echo, self.spectra, self.body.reflection)
        return arriving

    def _open_round_trip(self) -> None:
        self.motion, self.waves = self.functions.open(self.motion, self.waves, self.constants, self.loading[self.trip])

    def now(self) -> PlanarMotion:
        """Return the motion at the present moment as numpy arrays."""
        with our_settings():
            return PlanarMotion(*(whole(one) for one in self.motion))

    # ---- stop, and continue ------------------------------------------------------------------------------------------------------

    def sent(self, since: int) -> Floats:
        """Return W from a step of this round trip to the present one: (steps, 2, wavenumbers), without those that are filled up."""
        with our_settings():
            return np.asarray(whole(self.waves.sent[since : self.step + 1]))[..., : self.layout.half]

    def state(self) -> dict[str, Floats]:
        """Return what a run needs to continue, beside W since its start."""
        with our_settings():
            waves = {f"waves_{name}": whole(getattr(self.waves, name))[..., : self.layout.half] for name in KEPT}
            memory = self.half_space.saved(self.waves.memory, self.constants.half_space)
        waves |= {f"memory_{name}": one for name, one in memory.items()}
        return waves | {f"motion_{name}": one for name, one in self.now()._asdict().items()}

    def restore(self, state: Mapping[str, Floats], trip: int, step: int, sent: Callable[[int], Floats]) -> None:
        """Go to an earlier state of a run, of this number of devices or of another: what `state` returned.

        It was after `trip` whole round trips and `step` steps. `sent` is W at the steps of a round trip, the present one up to the
        present step, as `sent` returned it.
        """
        more = self.layout.modes[-1] - self.layout.half

        def filled(amplitudes: Any) -> Any:
            return np.pad(amplitudes, [(0, 0)] * (amplitudes.ndim - 1) + [(0, more)]) if amplitudes.ndim else amplitudes

        with our_settings():
            where, arriving = self.spread.waves, self.waves.arriving
            for n in range(trip):  # the echoes follow from what was sent
                arriving = self._turn(self.layout.put(filled(sent(n)), where.sent))
            kept = {name: filled(state[f"waves_{name}"]) for name in KEPT}
            saved = {name: filled(state[f"memory_{name}"]) for name in SAVED}
            memory = self._put(self.half_space.restored(saved, self.constants.half_space), where.memory)
            path = np.zeros((self.steps + 1, *self.waves.now.shape))
            path[: step + 1] = filled(sent(trip))
            put = {name: self.layout.put(value, getattr(where, name)) for name, value in (kept | {"sent": path}).items()}
            self.waves = PlanarWaves(memory, arriving=arriving, **put)
            self.motion = self._put(PlanarMotion(*(state[f"motion_{name}"] for name in PlanarMotion._fields)), self.spread.motion)
            self.trip, self.step = trip, step


KEPT = tuple(name for name in PlanarWaves._fields if name not in ("memory", "arriving", "sent"))
"""Fields of `PlanarWaves` that the state of a run holds."""


@contextmanager
def our_settings() -> Iterator[None]:
    """Have JAX compute with 64 bits and keep what it compiles, here only: other code of the user keeps its settings."""
    with COMPILED_BEFORE.in_use(), jax.enable_x64(True):
        yield
