"""What a run compiles: contacts that differ in numbers only share it, so that a second run begins at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import jax
from jax.sharding import PartitionSpec

from stickslip.planar.echo import Echo, echo_of
from stickslip.planar.friction import Contact, Nodes
from stickslip.planar.layout import Layout
from stickslip.planar.step import Constants, Motion, Step, Waves

ALIKE = PartitionSpec()
"""How an array is spread that every device holds."""


class Spread(NamedTuple):
    """How the arrays of a run are spread over devices."""

    motion: Motion
    waves: Waves
    echo: Echo
    constants: Constants
    spectra: PartitionSpec

    @classmethod
    def of(cls, layout: Layout, parameters: tuple[str, ...]) -> Spread:
        """Return how they are spread for a law with parameters of these names."""
        rank = len(layout.shape)
        y, more = layout.along_y(rank), layout.along_y(rank + 1)
        k, paths, histories = (layout.along_k(rank + extra) for extra in (1, 2, 3))
        nodes = Nodes(y, y, more, dict.fromkeys(parameters, more), y, ALIKE)
        return cls(
            motion=Motion(y, y, y, y, more, y, y),
            waves=Waves(paths, k, k, k, k, paths, paths),
            echo=Echo(histories, paths, paths, ALIKE, k),
            constants=Constants(nodes, y, paths, paths, layout.along_k(rank), ALIKE),
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
"""Number of compiled forms of runs that are kept at a time; each takes some 7 MB."""


@lru_cache(maxsize=MOST_FORMS)
def functions_of(contact: Contact, layout: Layout, parameters: tuple[str, ...]) -> Compiled:
    """Return the functions of runs with these formulas, this number of nodes and these names of parameters.

    JAX keeps what it has compiled of functions that are gone, so all is forgotten when there are too many forms. A run that goes on
    is then compiled once more.
    """
    if functions_of.cache_info().currsize >= MOST_FORMS:
        functions_of.cache_clear()
        jax.clear_caches()
    step, spread = Step(contact, layout), Spread.of(layout, parameters)

    def march(motion: Motion, waves: Waves, constants: Constants, loading: Any, between: Any) -> Any:
        def one(number: Any, now: tuple[Motion, Waves]) -> tuple[Motion, Waves]:
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
