"""Define a slab whose friction, normal stress and initial load vary along the contact: a line fault (2D) or a plane (3D)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.contact import regime_of
from stickslip.extensions.planar.nodes import NodeValues, full_names, node_values, varying
from stickslip.foundation.arguments import CheckedArguments, shown
from stickslip.foundation.conversion import Number, OptionalNumber, has_unit, without_unit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, check_fields, declare, quantity
from stickslip.problem import Problem, check_problem, features
from stickslip.problem.bodies import ElasticSlab

if TYPE_CHECKING:
    from stickslip.extensions.planar.solution import PlanarSolution

Profile = ArrayLike | Callable[..., Any]
"""Values at the nodes: an array, or a function of y, or of y and z (m), that returns one."""
FEWEST_NODES = 8
"""Smallest number of nodes along an axis of the contact."""
OTHER_BODIES = {
    "rigid": "a block has no waves",
    "uniform": "a string is a line, and the top of a column is free",
    "layered": "layers are followed in 1D only",
}
"""Why a contact has no other body than a slab, by the structure of that body."""
NOT_FOLLOWED = {
    features.DASHPOT: "is followed in 1D only",
    features.DRIVEN_BY_MACHINE: "is followed in 1D only",
    features.NORMAL_LOAD_THAT_VARIES: "is not followed along a contact",
    features.DRIVER_THAT_CHANGES: "is followed in 1D only",
    features.ONE_WAY: "is followed at one place only",
    features.MOVING_GROUND: "is followed at one place only",
}
"""What a problem may not have along a contact, and why."""
COUNTS = ("nodes", "width_nodes")
"""The fields that count nodes."""
MOST_STEPS = 1e12
"""Largest number of time steps of a run: the fastest take some years."""
MOST_NODES = 2**22
"""A slab has at most this many nodes: more do not fit into the memory that a run may take."""
WIDEST_STEP = 2.5
"""The steps were seen to be stable up to this phase w dt of the shortest wave in one time step."""
ENOUGH_NODES = 5.0
"""A front is called resolved with at least this many nodes in its process zone: a rule of thumb; test it with twice the nodes."""
PROCESS_ZONE = 9.0 * math.pi / 16.0
"""Length of the process zone of a slow front, times the largest -S mu'/G: K^2/(4 G) is the fracture energy (strength drop) Dc/2,
with K = 4/3 sqrt(2 length/pi) (strength drop)."""
STEEPEST = 0.5
"""Largest change of strength with slip in one time step, S |mu'| dt, as a share of the impedance."""


@dataclass(frozen=True, eq=False)
class PlanarSlab(CheckedArguments):
    """A slab of finite thickness with a contact along y (2D), or along y and z (3D), under scalar waves u_tt = c^2 lap u.

    Every node of the contact is the same `Problem`, a slab in 1D, except for the parameters that are given `along` the contact. If
    nothing varies along the contact, the solution is that of the problem in 1D.

    Parameters
    ----------
    problem
        Body (an `ElasticSlab` without contact mass), friction law, loading and start of every node.
    nodes
        Number of nodes along y: even.
    length
        Length of the contact along y (m).
    width
        Width of the contact along z (m), for a plane; None for a line, on which nothing varies with z.
    width_nodes
        Number of nodes along z: even; for a plane only.
    along
        Parameters that vary along the contact, by name: those of `problem.parameters` that belong to friction ("friction.static"),
        "body.normal_stress", "initial.slip", "initial.load", "initial.excess" and "initial.state". Each is an array with one entry
        for each node, in SI or as texts with units, or a function of y, or of y and z (m, 0 in the middle), that returns such an
        array.
    barrier
        Where the contact is locked and never slips: an array of booleans, or a function of y, or y and z, that returns one.
    replicas
        True if the contact is periodic. False if it is alone: it is locked outside of the given length and width.
    courant
        Largest wave speed times time step over distance between nodes. Friction that varies within little slip needs shorter steps,
        which are chosen by themselves. A run with half the value and twice the nodes shows how accurate a run is.

    Raises
    ------
    InputError
        If a value is out of range; if several slip rates may solve the contact equation at a node; if the problem has a
        contact mass, or a law whose state reverses. The message is one line that says which.

    Notes
    -----
    A driver of finite impedance is a half-space with the wave speed of the slab, so that it reflects waves of all directions alike.
    """

    problem: Problem
    nodes: int = declare(Quantity("1", "number of nodes along y, even", at_least=FEWEST_NODES))
    length: Number = quantity("m", "length of the contact along y", above=0)
    width: OptionalNumber = quantity("m", "width of the contact along z, for a plane", above=0, default=None)
    width_nodes: int | None = declare(Quantity("1", "number of nodes along z, even, for a plane", at_least=FEWEST_NODES), None)
    along: Mapping[str, Profile] = field(default_factory=dict)
    barrier: Profile | None = None
    replicas: bool = True
    courant: Number = quantity("1", "wave speed times time step over distance between nodes", above=0, default=0.5)

    def __post_init__(self) -> None:
        check_problem("PlanarSlab", self.problem)
        check_fields(self, but=COUNTS)
        self._check_problem()
        self._check_grid()
        _ = self.values, self.locked
        self._check_uniqueness()

    def _check_problem(self) -> None:
        problem, law = self.problem, self.problem.friction
        if not isinstance(problem.body, ElasticSlab):
            why = OTHER_BODIES.get(problem.body.structure, "other bodies are followed in 1D only")
            raise InputError(f"PlanarSlab: body must be an ElasticSlab, got {shown(problem.body)}: {why}")
        if problem.body.contact_mass != 0.0:
            raise InputError("PlanarSlab: contact_mass must be 0: the contact equation is solved without inertia")
        features.refuse("PlanarSlab", problem, NOT_FOLLOWED)
        if law.reverses:
            raise InputError(
                f"PlanarSlab: {type(law).__name__} has a state that reverses with slip, which planar slabs do not follow"
            )
        if law.backward_from:
            raise InputError(
                f"PlanarSlab: friction of {type(law).__name__} differs with the direction of slip, which planar slabs do not follow"
            )
        if problem.rule != "perfect-delay":
            raise InputError(
                f"PlanarSlab: the selection rule {problem.rule!r} would have no effect: laws under which it has one are refused,"
                " because waves along the contact make them ill-posed"
            )

    def _check_grid(self) -> None:
        if (self.width is None) != (self.width_nodes is None):
            raise InputError("PlanarSlab: width and width_nodes belong together: give both for a plane, neither for a line")
        for name in COUNTS:
            count = getattr(self, name)
            if count is None:
                continue
            if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < FEWEST_NODES or count % 2:
                raise InputError(f"PlanarSlab: {name} must be an even whole number, at least {FEWEST_NODES}, got {shown(count)}")
        if math.prod(self.shape) > MOST_NODES:
            raise InputError(f"PlanarSlab: a contact may have {MOST_NODES} nodes, got {' x '.join(map(str, self.shape))}")
        finest = math.sqrt(sum((math.pi / step) ** 2 for step in self.spacing))
        largest = WIDEST_STEP / (finest * min(self.spacing))
        if self.courant > largest:
            raise InputError(
                f"PlanarSlab: courant must be at most {largest:.3g} here, got {self.courant:g}: steps would be unstable"
            )

    def _check_uniqueness(self) -> None:
        """Refuse contacts on which several slip rates solve the contact equation: the paper's perfect delay does not carry over."""
        for problem in self.values.problems:
            law = problem.friction
            if law.states or (not law.depends_on_rate):
                continue
            regime = regime_of(problem)
            if regime != "regular":
                raise InputError(
                    "PlanarSlab: friction falls with the slip rate by more than radiation adds (the contact equation of this"
                    f" {type(law).__name__} is {regime}): the shorter a disturbance along the contact, the faster it grows, without"
                    " bound, and no selection rule is known to give a solution; let it follow the slip rate with a lag (the law"
                    " 'lagged', see docs/rate-law-on-a-fault.md), or take slip weakening, rate and state, or a smaller fall"
                )

    @property
    def run_type(self) -> type[PlanarSolution]:
        """The class of its runs."""
        from stickslip.extensions.planar.solution import PlanarSolution

        return PlanarSolution

    @property
    def body(self) -> ElasticSlab:
        """The slab of every node; only its normal stress may vary."""
        assert isinstance(self.problem.body, ElasticSlab)
        return self.problem.body

    @property
    def is_plane(self) -> bool:
        """True for a plane of contact (3D), False for a line (2D)."""
        return self.width is not None

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of nodes along y, and along z for a plane."""
        return (self.nodes,) if self.width_nodes is None else (self.nodes, self.width_nodes)

    @property
    def extent(self) -> tuple[float, ...]:
        """The length (m), and the width (m) of a plane."""
        return (float(self.length),) if self.width is None else (float(self.length), float(self.width))

    @property
    def spacing(self) -> tuple[float, ...]:
        """The distance between nodes along y, and along z for a plane (m)."""
        return tuple(size / count for size, count in zip(self.extent, self.shape, strict=True))

    @property
    def node_area(self) -> float:
        """The contact area of a node: m^2, or m^2 per metre of the z direction for a line."""
        return math.prod(self.spacing)

    @property
    def y(self) -> NDArray[np.float64]:
        """The positions of the nodes along y (m), 0 in the middle."""
        return _positions(self.shape[0], self.spacing[0])

    @property
    def z(self) -> NDArray[np.float64]:
        """The positions of the nodes along z (m), 0 in the middle; an empty array for a line."""
        return _positions(self.shape[1], self.spacing[1]) if self.is_plane else np.empty(0)

    @property
    def reach(self) -> float:
        """Slip (m) that is hardly exceeded: twice the slip that would take all load off a slab at rest."""
        return 2.0 * float(np.abs(self.values.load).max()) * self.body.thickness / self.body.shear_modulus

    def nodes_per_process_zone(self, reach: float) -> float:
        """Return the nodes within the process zone of a slow front, where friction falls from its peak; NaN if it does not fall.

        It is 9 pi/16 G divided by the largest fall of strength with slip (Pa/m) and by the distance of nodes: the length over which
        strength that falls linearly with distance takes the fracture energy of linear slip weakening. (Between two half-spaces it
        is 9 pi/32, for which codes cite Day et al. 2005.) Zones of slow fronts were measured to have 5/6 of it, in
        `tests/extensions/planar/test_long_faults.py`; those of fronts of speed V are shorter by sqrt(1 - V^2/c^2).

        Parameters
        ----------
        reach
            Range of slip (m) from the start for evaluating strength.
        """
        fall = self.values.steepest_fall(reach, self.body.impedance) if reach > 0.0 else 0.0  # no slip, no front
        return PROCESS_ZONE * self.body.shear_modulus / fall / max(self.spacing) if fall > 0.0 else math.nan

    @cached_property
    def steps_per_round_trip(self) -> int:
        """The number of time steps in a two-way travel time R.

        It is the smallest that keeps to `courant`, and in which radiation outweighs the change of strength with slip: S |mu'| dt
        is at most Z/2, up to a slip of `reach`.
        """
        steep = max(self.values.slopes(self.reach)) if self.reach > 0.0 else 0.0
        waves = 2.0 * self.body.thickness / (self.courant * min(self.spacing))
        needed = max(1.0, waves, self.body.two_way_time * steep / (STEEPEST * self.body.impedance))
        if not needed <= MOST_STEPS:
            raise InputError(f"PlanarSlab: a round trip needs {needed:.3g} time steps, allowed are {MOST_STEPS:g}")
        return math.ceil(needed - 1e-9)

    def steps(self, duration: float) -> int:
        """Return the number of time steps of a run of this duration (s). Raises InputError for more than a run can take."""
        needed = duration / self.body.two_way_time * self.steps_per_round_trip
        if not needed <= MOST_STEPS:
            raise InputError(f"PlanarSlab: {duration:g} s are {needed:.3g} time steps, allowed are {MOST_STEPS:g}")
        return max(1, math.ceil(needed - 1e-9))

    def round_trips(self, duration: float) -> int:
        """Return the number of round trips that a run of this duration (s) begins. Raises InputError as `steps` does."""
        _ = self.steps(duration)
        return max(1, math.ceil(duration / self.body.two_way_time - 1e-9))

    def alone_for(self, duration: float) -> tuple[PlanarSlab, tuple[slice, ...]]:
        """Return a periodic slab that holds this contact so far from its replicas that no wave of them arrives in time.

        Parameters
        ----------
        duration
            Time (s).

        Returns
        -------
        tuple
            The slab, which is locked outside of this contact, and where in it the nodes of this contact are. For a contact with
            replicas they are this slab and all its nodes.
        """
        if self.replicas:
            return self, tuple(slice(None) for _ in self.shape)
        from scipy.fft import next_fast_len  # takes a tenth of a second to load, which other runs do not need

        reach = self.body.wave_speed * duration
        wanted = [count + reach / step for count, step in zip(self.shape, self.spacing, strict=True)]
        if not math.prod(wanted) <= MOST_NODES:
            needed = " x ".join(f"{np.ceil(one):.15g}" for one in wanted)
            raise InputError(f"PlanarSlab: {duration:g} s without replicas need {needed} nodes, allowed are {MOST_NODES}")
        counts = [2 * next_fast_len(math.ceil(one / 2)) for one in wanted]
        more = [large - count for large, count in zip(counts, self.shape, strict=True)]
        room = [(extra // 2, extra - extra // 2) for extra in more]
        along = {name: np.pad(self.at_nodes(name, given), room, mode="edge") for name, given in self.along.items()}
        sizes = [count * step for count, step in zip(counts, self.spacing, strict=True)]
        width = {"width": sizes[1], "width_nodes": counts[1]} if self.is_plane else {}
        barrier = np.pad(self.locked, room, constant_values=True)
        large = replace(self, nodes=counts[0], length=sizes[0], along=along, barrier=barrier, replicas=True, **width)
        return large, tuple(slice(before, before + count) for (before, _), count in zip(room, self.shape, strict=True))

    def at_nodes(self, name: str, given: Profile, kind: type = float) -> NDArray[Any]:
        """Return the values of a profile at the nodes in SI, with the shape `shape`.

        Raises InputError if they do not fit the nodes, or are not finite numbers; `name` begins the message.
        """
        where = (self.y,) if not self.is_plane else tuple(np.meshgrid(self.y, self.z, indexing="ij"))
        try:
            values = given(*where) if callable(given) else given
            values = np.asarray(values if kind is bool else self._in_si(name, values))
            values = np.array(np.broadcast_to(values, self.shape), kind)
        except InputError:
            raise
        except (TypeError, ValueError) as error:
            raise InputError(f"PlanarSlab: {name} must give {self.shape} values, one for each node: {error}") from None
        if not np.isfinite(values).all():
            raise InputError(f"PlanarSlab: {name} must be finite at every node")
        return values

    def _in_si(self, name: str, values: Any) -> Any:
        """Return values without units, which texts and quantities of pint may have. Raises InputError."""
        listed = np.asarray(values, object) if isinstance(values, str | list | tuple) else None
        if not has_unit(values) and (listed is None or not any(isinstance(one, str) for one in listed.flat)):
            return values
        full = full_names(self.problem, [name], "PlanarSlab: along")[name]
        declared = varying(self.problem)[full][0]
        if listed is None:
            return without_unit(values, declared.unit)
        read = [declared.check("PlanarSlab", f"along {name}", one) for one in listed.flat]
        return np.reshape(np.array(read), listed.shape)

    @cached_property
    def values(self) -> NodeValues:
        """The numbers of each node: see `NodeValues`."""
        if not isinstance(self.along, Mapping):
            raise InputError(f"PlanarSlab: along must be a mapping from names to profiles, got {shown(self.along)}")
        along = {name: self.at_nodes(name, profile) for name, profile in self.along.items()}
        return node_values(self.problem, along, self.shape)

    @cached_property
    def locked(self) -> NDArray[np.bool_]:
        """True at the nodes of the barrier, with the shape `shape`."""
        return self.at_nodes("barrier", False if self.barrier is None else self.barrier, bool)


def _positions(count: int, spacing: float) -> NDArray[np.float64]:
    return np.asarray((np.arange(count) - count // 2) * spacing, float)
