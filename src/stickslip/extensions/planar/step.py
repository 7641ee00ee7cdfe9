"""One step of a planar slab in time, and its arrays: predictor and corrector for slip, at all nodes at once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp

from stickslip.extensions.planar.friction import ContactOfNodes, Nodes
from stickslip.extensions.planar.half_space import StepByStep
from stickslip.extensions.planar.layout import Layout


class PlanarMotion(NamedTuple):
    """The contact at one moment, as arrays over the nodes."""

    slip: Any
    """Slip, m."""
    rate: Any
    """Slip rate, m/s."""
    traction: Any
    """Friction, Pa, with the sign of the slip rate; at rest the load."""
    seen: Any
    """Slip as the law counts it, m."""
    states: Any
    """States in the form that the formulas use, one more axis in front."""
    heat: Any
    """Work of friction since the start, J/m^2."""
    residual: Any
    """Largest |Z v + tau - load| so far, as a share of the load: how well the contact equation has been solved."""

    def at(self, nodes: tuple[slice, ...]) -> PlanarMotion:
        """Return the motion of some of the nodes."""
        return PlanarMotion(*(one[(..., *nodes)] for one in self))


class PlanarWaves(NamedTuple):
    """What waves do, as amplitudes over the wavenumbers: the last axes are 2 (real and imaginary part) and the wavenumbers."""

    memory: Any
    """What the half-space remembers: `HalfSpaceMemory`."""
    inherited: Any
    """The part of F at the end of the next step that does not depend on slip there, Pa."""
    now: Any
    """F at the present moment, Pa."""
    slip: Any
    """Slip since the start, m."""
    rate: Any
    """Slip rate, m/s."""
    arriving: Any
    """P at the steps of this round trip, Pa."""
    sent: Any
    """W at the steps of this round trip so far, Pa."""


class Constants(NamedTuple):
    """What does not change in a run."""

    nodes: Nodes
    initial_load: Any
    half_space: Any
    """What its memory is advanced with: `HalfSpaceNumbers`."""
    now: Any
    length: Any
    """Length of a step of time, s."""


@dataclass(frozen=True)
class PlanarStep:
    """A step of a contact whose fields and wavenumbers are spread as a layout says: what is compiled, without numbers."""

    contact: ContactOfNodes
    layout: Layout
    half_space: StepByStep

    def opened(
        self, motion: PlanarMotion, waves: PlanarWaves, constants: Constants, loading: Any
    ) -> tuple[PlanarMotion, PlanarWaves]:
        """Return motion and waves just after a round trip has begun, when its echo has arrived."""
        load = constants.initial_load + loading[0] + self.layout.field(waves.now + waves.arriving[0])
        rate = self.contact.rate(constants.nodes, load, motion.seen, motion.states, motion.rate)
        traction = self.contact.traction(constants.nodes, load, motion.seen, motion.states, rate)
        motion = motion._replace(rate=rate, traction=traction, residual=_residual(motion, constants, load, (rate, traction)))
        waves = waves._replace(rate=self.layout.amplitudes(rate))
        return motion, waves._replace(sent=waves.sent.at[0].set(_leaving(waves, constants, waves.arriving[0])))

    def taken(
        self, now: tuple[PlanarMotion, PlanarWaves], constants: Constants, loading: Any, step: Any
    ) -> tuple[PlanarMotion, PlanarWaves]:
        """Return motion and waves after the step with a number in its round trip: a predictor, then a corrector."""
        motion, waves = now
        arriving = jax.lax.dynamic_index_in_dim(waves.arriving, step, keepdims=False)
        loads = constants.initial_load + loading, arriving
        guess, _ = self._moved(now, (motion, waves.rate), constants, loads)
        found, waves = self._moved(now, (guess, self.layout.amplitudes(guess.rate)), constants, loads)
        memory, inherited = self.half_space.advanced(waves.memory, constants.half_space, waves.slip)
        waves = waves._replace(memory=memory, inherited=inherited, rate=self.layout.amplitudes(found.rate))
        sent = jax.lax.dynamic_update_index_in_dim(waves.sent, _leaving(waves, constants, arriving), step, 0)
        return found, waves._replace(sent=sent)

    def _moved(
        self, now: tuple[PlanarMotion, PlanarWaves], guess: tuple[PlanarMotion, Any], constants: Constants, loads: Any
    ) -> Any:
        """Return the motion after a step, and the waves with slip and F there, from a guess of that motion.

        The amplitudes of the slip rate of the guess belong to it. Those of slip follow without a Fourier transform of their own.
        """
        motion, waves = now
        late, amplitudes = guess
        mean = 0.5 * (motion.rate + late.rate)
        length = constants.length
        slip = motion.slip + length * mean
        seen, states = self._counted(motion, mean, late, constants)
        slipped = waves.slip + 0.5 * length * (waves.rate + amplitudes)
        waves = waves._replace(slip=slipped, now=waves.inherited + constants.now * slipped)
        load = loads[0] + self.layout.field(waves.now + loads[1])
        rate = self.contact.rate(constants.nodes, load, seen, states, late.rate)
        traction = self.contact.traction(constants.nodes, load, seen, states, rate)
        if self.contact.memory == "since-arrest":
            seen = jnp.where(rate == 0.0, 0.0, seen)
        heat = motion.heat + 0.5 * length * (motion.traction * motion.rate + traction * rate)
        return PlanarMotion(slip, rate, traction, seen, states, heat, _residual(motion, constants, load, (rate, traction))), waves

    def _counted(self, motion: PlanarMotion, mean: Any, guess: PlanarMotion, constants: Constants) -> tuple[Any, Any]:
        """Return slip as the law counts it, and the states, after a step at a mean slip rate."""
        path = jnp.abs(mean) if self.contact.counts == "path" else mean
        seen = motion.seen + constants.length * path
        if not self.contact.state_trees:
            return seen, motion.states
        about = 0.5 * (motion.states + guess.states)
        middle = (0.5 * (motion.seen + seen), jnp.abs(mean))
        return seen, self.contact.advanced_states(constants.nodes, middle, (motion.states, about), constants.length)


def _residual(motion: PlanarMotion, constants: Constants, load: Any, found: tuple[Any, Any]) -> Any:
    """Return `PlanarMotion.residual` after a step that ends in this load, and in a slip rate and traction that were found."""
    rate, traction = found
    missed = jnp.abs((constants.nodes.impedance * rate + traction) / load - 1.0)
    return jnp.maximum(motion.residual, jnp.where(rate == 0.0, 0.0, missed))


def _leaving(waves: PlanarWaves, constants: Constants, arriving: Any) -> Any:
    return 2.0 * constants.nodes.impedance * waves.rate - 2.0 * waves.now - arriving
