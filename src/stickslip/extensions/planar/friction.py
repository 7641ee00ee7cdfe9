"""The friction law and the contact equation at all nodes, in JAX: the formulas that the engine compiles.

Each node has its own parameters. Nodes in different pieces of a law share the formula where they can, and only its numbers differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

from stickslip.extensions.planar.nodes import NodeValues
from stickslip.friction import FrictionLaw
from stickslip.friction.formula import LARGEST_EXPONENT, STATES, VARIABLES, Expression, limited, nodes_of, operation_of

ITERATIONS = 80
"""Largest number of steps of Newton's method or bisection; from the slip rate of the step before it takes two to four."""


def evaluated(tree: Expression, numbers: dict[str, Any], variables: tuple[Any, ...]) -> Any:
    """Return a formula from the parameters by name and the variables: slip (m), slip rate (m/s), states."""
    found: dict[Expression, Any] = dict.fromkeys(STATES, 0.0) | dict(zip(VARIABLES, variables, strict=False))
    cut = limited(tree)
    for node in nodes_of(tree):
        if node.operation == "parameter":
            found[node] = numbers[node.name]
        elif node.operation == "constant":
            found[node] = node.value
        elif node.arguments:
            given = [found[argument] for argument in node.arguments]
            if node in cut:
                given = [jnp.minimum(given[0], LARGEST_EXPONENT)]
            found[node] = getattr(jnp, operation_of(node).on_arrays.__name__)(*given)
    return found[tree]


class Nodes(NamedTuple):
    """What the contact equation needs of the nodes, as arrays whose last axes are those of the contact: see `NodeValues`."""

    normal: Any
    static_excess: Any
    knots: Any
    numbers: dict[str, Any]
    """For each parameter an array with the pieces of the law in front."""
    free: Any
    """False at nodes that are locked."""
    impedance: Any
    """Z of the waves that slip sends away, Pa s/m: one number."""

    @classmethod
    def of(cls, values: NodeValues, locked: Any, impedance: float) -> Nodes:
        """Return the arrays of the nodes, in numpy."""
        numbers = {name: np.stack([piece[name] for piece in values.numbers]) for name in values.numbers[0]}
        return cls(values.normal, values.static_excess, values.knots, numbers, ~locked, np.float64(impedance))


@dataclass(frozen=True)
class ContactOfNodes:
    """The formulas of a law at all nodes, without its numbers: laws that differ in numbers only are compiled once."""

    trees: tuple[Expression, ...]
    state_trees: tuple[Expression, ...]
    knot_variable: str
    depends_on_rate: bool
    """True also for a law with states."""
    memory: str
    counts: str

    @classmethod
    def of(cls, law: FrictionLaw) -> ContactOfNodes:
        """Return the formulas of a law."""
        of_rate = law.depends_on_rate or bool(law.states)
        return cls(law.trees(), law.state_trees(), law.knot_variable, of_rate, law.memory, law.counts)

    def coefficient(self, nodes: Nodes, slip: Any, rate: Any, states: Any) -> Any:
        """Return mu at slip (m) as the law counts it and slip rate (m/s), not negative, in given states."""
        trees = self.trees
        if len(trees) == 1:
            return evaluated(trees[0], {name: value[0] for name, value in nodes.numbers.items()}, (slip, rate, *states))
        variable = slip if self.knot_variable == "slip" else rate
        piece = jnp.sum(jnp.broadcast_to(variable, slip.shape) >= nodes.knots, axis=0)
        numbers = {name: jnp.take_along_axis(value, piece[None], axis=0)[0] for name, value in nodes.numbers.items()}
        found = jnp.zeros(slip.shape)
        for tree in dict.fromkeys(trees):
            own = np.array([tree == one for one in trees])
            value = evaluated(tree, numbers, (slip, rate, *states))
            found = jnp.where(jnp.asarray(own)[piece], value, found)
        return found

    def rate(self, nodes: Nodes, load: Any, slip: Any, states: Any, guess: Any) -> Any:
        """Solve Z v + tau = load at each node (paper eqs 12-13), with tau against the direction of slip.

        Parameters
        ----------
        nodes
            The numbers of the nodes.
        load
            Load (Pa), of any sign.
        slip
            Slip as the law counts it (m).
        states
            States in the form that the formulas use, one more axis in front.
        guess
            A slip rate (m/s) where the search begins.

        Returns
        -------
        array
            The slip rate (m/s), with the sign of the load; 0 where the strength bears it, and where the contact is locked.
        """
        size = jnp.abs(load)
        at_rest = nodes.normal * self.coefficient(nodes, slip, jnp.zeros_like(slip), states)
        slips = nodes.free & (size > at_rest + nodes.normal * nodes.static_excess)
        if self.depends_on_rate:
            found = self._root(nodes, size, (slip, states, at_rest), jnp.abs(guess))
        else:
            found = (size - at_rest) / nodes.impedance
        return jnp.where(slips, jnp.sign(load) * found, 0.0)

    def traction(self, nodes: Nodes, load: Any, slip: Any, states: Any, rate: Any) -> Any:
        """Return the traction (Pa) at a slip rate that `rate` has found: friction from the law, and the load of nodes at rest."""
        friction = nodes.normal * self.coefficient(nodes, slip, jnp.abs(rate), states)
        return jnp.where(rate == 0.0, load, jnp.sign(rate) * friction)

    def _root(self, nodes: Nodes, size: Any, at: tuple[Any, Any, Any], guess: Any) -> Any:
        """Return the root of each node by Newton's method, which bisects where it would leave the bracket."""
        slip, states, at_rest = at

        def missing(rate: Any) -> tuple[Any, Any]:
            def of_rate(v: Any) -> Any:
                return nodes.impedance * v + nodes.normal * self.coefficient(nodes, slip, v, states) - size

            value, slope = jax.jvp(of_rate, (rate,), (jnp.ones_like(rate),))
            return value, slope

        def widened(bracket: tuple[Any, Any]) -> tuple[Any, Any]:
            high, _ = bracket
            short = missing(high)[0] < 0.0
            return jnp.where(short, 2.0 * high, high), short

        def step(search: tuple[Any, ...]) -> tuple[Any, ...]:
            low, high, rate, _, count = search
            value, slope = missing(rate)
            low, high = jnp.where(value <= 0.0, rate, low), jnp.where(value > 0.0, rate, high)
            newton = rate - value / slope
            middle = jnp.where(low > 0.0, jnp.sqrt(low) * jnp.sqrt(high), 1e-3 * high)
            # where a step is this small, the next one would change the rate by less than the square of it
            small = jnp.abs(newton - rate) <= 1e-9 * rate
            following = jnp.where(small | ((low < newton) & (newton < high)), newton, middle)
            done = jnp.abs(following - rate) <= 1e-9 * rate
            return low, high, following, done, count + 1

        tiny = jnp.finfo(jnp.float64).tiny
        high = jnp.maximum((size - at_rest) / nodes.impedance, tiny)
        high, _ = jax.lax.while_loop(lambda bracket: jnp.any(bracket[1]), widened, (high, jnp.ones(high.shape, bool)))
        start = jnp.where((guess > 0.0) & (guess < high), guess, 0.5 * high)
        search = (jnp.zeros_like(high), high, start, jnp.zeros(high.shape, bool), 0)
        search = jax.lax.while_loop(lambda now: ~jnp.all(now[3]) & (now[4] < ITERATIONS), step, search)
        return search[2]

    def advanced_states(self, nodes: Nodes, motion: tuple[Any, Any], states: tuple[Any, Any], step: float) -> Any:
        """Return the states after a step, for slip and slip rate that are constant in it: order 2 with those of its middle.

        Parameters
        ----------
        nodes
            The numbers of the nodes.
        motion
            Slip (m) as the law counts it, and slip rate (m/s), not negative.
        states
            The states at the beginning, and those about which their evolution is made linear.
        step
            Length of the step (s).
        """
        begin, about = states
        found = []
        numbers = {name: value[0] for name, value in nodes.numbers.items()}
        for i, tree in enumerate(self.state_trees):

            def of_state(w: Any, i: int = i, tree: Expression = tree) -> Any:
                return evaluated(tree, numbers, (*motion, *(w if j == i else about[j] for j in range(len(about)))))

            value, slope = jax.jvp(of_state, (about[i],), (jnp.ones_like(about[i]),))
            value = jnp.broadcast_to(value, about[i].shape)
            linear = step * slope
            share = jnp.where(jnp.abs(linear) < 1e-12, 1.0, jnp.expm1(linear) / jnp.where(linear == 0.0, 1.0, linear))
            found.append(begin[i] + step * share * (value - slope * (about[i] - begin[i])))
        return jnp.stack(found) if found else begin
