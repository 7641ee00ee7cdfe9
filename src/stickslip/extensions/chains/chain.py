"""A chain or a lattice of blocks: what a user states of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, field, fields
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.chains.couplings import Couplings, array_of, checked_coupling, couplings_of
from stickslip.extensions.chains.drawn import Drawn
from stickslip.foundation.arguments import CheckedArguments, check_whole, shown
from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Choice, Quantity, check_fields, quantity
from stickslip.foundation.show import MOST_SHOWN
from stickslip.friction import FrictionLaw

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun

MOST_BLOCKS = 1_000_000
"""A chain has at most this many blocks."""
FEWEST_IN_CIRCLE = 3
"""A periodic chain has at least this many blocks, so that the two neighbours of each are two."""
OF_BLOCKS: Mapping[str, Quantity] = MappingProxyType(
    {
        "mass": Quantity("kg", "mass m of a block", above=0),
        "stiffness": Quantity("N/m", "stiffness kp of the spring to the driver", at_least=0),
        "normal_force": Quantity("N", "normal force on the contact; 0: no friction", at_least=0),
        "damping": Quantity("N s/m", "dashpot between the block and the ground", at_least=0),
        "initial_slip": Quantity("m", "slip at the start"),
    }
)
"""The numbers that each block has of its own."""
Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Chain(CheckedArguments):
    """Blocks coupled by springs to their neighbours, and pulled through springs by one driver: the chain of Burridge and Knopoff.

    m u_j'' = kc (u_(j+1) - u_j) + kc (u_(j-1) - u_j) + kp (V t - u_j) - damping u_j' - friction, at rest from t = 0 on where
    friction is strong enough. `stickslip.simulate(chain, duration)` solves it.

    Parameters
    ----------
    friction : FrictionLaw or sequence of FrictionLaw
        A law of `stickslip.friction` that depends on slip and slip rate and sticks, the same for all blocks; or one for each block.
    blocks : int or (int, int)
        Number of blocks, or of the rows and the columns of a lattice, whose blocks are counted row after row.
    mass, stiffness, normal_force, damping, initial_slip : float, str, array or Drawn
        Of each block its mass (kg), the stiffness of its spring to the driver (N/m), the normal force on its contact (N; 0: it has
        no friction), its dashpot to the ground (N s/m), and its slip at the start (m): a number for all, a text with a unit, an
        array of one for each, or numbers that are drawn: `Drawn`.
    coupling : float, str, array, pair or sparse matrix
        Stiffness (N/m) of the springs between neighbours: one for all; an array of n - 1 of them (n in a periodic chain, n + 1 with
        fixed ends); for a lattice a pair, along rows and along columns; or a symmetric matrix of scipy.sparse, whose entry [j, k]
        is the spring between blocks j and k.
    pull_rate : float or str
        Velocity V of the driver (m/s).
    ends : "free", "fixed" or "periodic", default "free"
        Whether the outer blocks have no further neighbour, are held by a spring to a wall at 0, or by each other.
    direction : "both" or "forward", default "both"
        Whether blocks may slip back, or friction then resists without limit, as in much of the literature. Blocks without friction
        go back in any case.

    Raises
    ------
    InputError
        If a value cannot be used. The message is one line that says which.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.Coulomb(static=1.0, dynamic=0.8)
    >>> chain = ss.Chain(law, 2, mass=1.0, coupling=1.2, stiffness=1.0, normal_force=[1.0, 1.3], pull_rate="1 mm/s")
    >>> chain.values("normal_force")
    array([1. , 1.3])
    """

    friction: Any
    blocks: Any
    mass: Any
    coupling: Any
    stiffness: Any
    normal_force: Any
    pull_rate: Number = quantity("m/s", "velocity V of the driver")
    damping: Any = field(default=0.0, kw_only=True)
    ends: str = field(default="free", kw_only=True, metadata={"declared": Choice("the ends", ("free", "fixed", "periodic"))})
    initial_slip: Any = field(default=0.0, kw_only=True)
    direction: str = field(
        default="both", kw_only=True, metadata={"declared": Choice("where blocks may slip to", ("both", "forward"))}
    )

    def __post_init__(self) -> None:
        object.__setattr__(self, "blocks", self._checked_blocks())
        check_fields(self)
        _ = self.laws
        for name, kind in OF_BLOCKS.items():
            object.__setattr__(self, name, self._checked(name, kind))
        if self.ends == "periodic" and min(self.shape) < FEWEST_IN_CIRCLE:
            raise InputError(f"Chain: a periodic chain needs at least {FEWEST_IN_CIRCLE} blocks in a circle, got {min(self.shape)}")
        object.__setattr__(self, "coupling", checked_coupling(self.coupling, self.shape, self.ends))
        if self.direction == "forward" and self.pull_rate < 0.0:
            raise InputError(f"Chain: direction 'forward' needs a pull_rate of 0 or more, got {self.pull_rate:g} m/s")

    def _checked_blocks(self) -> Any:
        given = self.blocks
        several = isinstance(given, tuple | list) or (isinstance(given, np.ndarray) and given.ndim > 0)
        if several and len(given) != 2:
            raise InputError(f"Chain: blocks must be a number, or the rows and columns of a lattice, got {len(given)} numbers")
        sides = tuple(check_whole("Chain: blocks", one) for one in (given if several else (given,)))
        if np.prod(sides, dtype=object) > MOST_BLOCKS:
            raise InputError(f"Chain: blocks must be at most {MOST_BLOCKS}, got {np.prod(sides, dtype=object)}")
        return sides if several else sides[0]

    def _checked(self, name: str, kind: Quantity) -> Any:
        """Return a number of each block as it is kept: a float, a checked array, or a checked draw."""
        given = getattr(self, name)
        if isinstance(given, Drawn):
            drawn = given.values(self.count, kind.unit)
            for i in np.flatnonzero(~kind.allows(drawn))[:1]:
                try:
                    kind.check("Chain", name, float(drawn[i]))
                except InputError as error:
                    raise InputError(f"{error}, drawn for block {i}: {given.text}") from None
            return given
        if isinstance(given, list | tuple) or (isinstance(given, np.ndarray) and given.ndim > 0):
            shape = shape_of(given)
            if shape and shape not in {(self.count,), self.shape}:
                wanted = f"{self.count} numbers" + (
                    f", or {self.shape[0]} rows of {self.shape[1]}," if len(self.shape) == 2 else ""
                )
                raise InputError(f"Chain: {name} must have {wanted} as there are blocks, got {' by '.join(map(str, shape))}")
            flat = [one for row in given for one in row] if len(shape) == 2 and isinstance(given, list | tuple) else given
            return array_of(kind, name, flat)
        return kind.check("Chain", name, given)

    def __repr__(self) -> str:
        given = ((one, getattr(self, one.name)) for one in fields(self))
        told = (
            f"{one.name}={short(value)}" for one, value in given if one.default is MISSING or short(value) != short(one.default)
        )
        return f"Chain({', '.join(told)})"

    # ---- what follows ---------------------------------------------------------------------------------------------------------

    @property
    def shape(self) -> tuple[int, ...]:
        """The number of blocks, or of rows and columns, as a tuple."""
        return self.blocks if isinstance(self.blocks, tuple) else (self.blocks,)

    @property
    def count(self) -> int:
        """The number of blocks."""
        return int(np.prod(self.shape))

    def values(self, name: str) -> Floats:
        """Return the numbers of all blocks (SI) by name: "mass", "stiffness", "normal_force", "damping" or "initial_slip"."""
        if not isinstance(name, str) or name not in OF_BLOCKS:
            raise InputError(f"Chain: {shown(name)} is no number of each block; {nearest(str(name), OF_BLOCKS)}")
        kind, given = OF_BLOCKS[name], getattr(self, name)
        if isinstance(given, Drawn):
            return given.values(self.count, kind.unit)
        return np.array(given) if isinstance(given, np.ndarray) else np.full(self.count, float(given))

    @cached_property
    def laws(self) -> tuple[tuple[FrictionLaw, ...], NDArray[np.int64]]:
        """The different laws, and for each block which of them it has."""
        given = self.friction
        if isinstance(given, FrictionLaw):
            laws: list[FrictionLaw] = [given]
            which = np.zeros(self.count, np.int64)
        elif isinstance(given, list | tuple | np.ndarray):
            if len(given) != self.count:
                raise InputError(f"Chain: friction must be one law, or one for each of {self.count} blocks, got {len(given)}")
            known: dict[int, int] = {}
            laws, numbers = [], []
            for one in given:
                if id(one) not in known:
                    same = next((i for i, law in enumerate(laws) if type(law) is type(one) and law == one), len(laws))
                    known[id(one)] = same
                    laws += [one] if same == len(laws) else []
                numbers.append(known[id(one)])
            which = np.array(numbers, np.int64)
        else:
            laws, which = [given], np.zeros(0, np.int64)
        for law in laws:
            check_law(law)
        return tuple(laws), which

    @cached_property
    def couplings(self) -> Couplings:
        """The springs between blocks, as rows of neighbours."""
        return couplings_of(self.coupling, self.shape, self.ends)

    @property
    def run_type(self) -> type[ChainRun]:
        """The class of its runs."""
        from stickslip.extensions.chains.run import ChainRun

        return ChainRun


def shape_of(given: Any) -> tuple[int, ...]:
    """Return the shape of a list or an array, or () for a list of lists of unequal length, whose first list is then refused."""
    try:
        return np.shape(given)
    except ValueError:
        return ()


def short(value: Any) -> str:
    """Return what a chain is given as a short text: of many numbers their count, the least and the greatest."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        return f"<{value.size} numbers, {value.min():.6g} to {value.max():.6g}>" if value.size > MOST_SHOWN else str(value.tolist())
    if isinstance(value, list | tuple | np.ndarray) and len(value) > MOST_SHOWN:
        return f"<{len(value)} laws, {len(set(map(repr, value)))} different>"
    return repr(value)


def check_law(law: Any) -> None:
    """Refuse what cannot be the friction of a block. Raises InputError."""
    if not isinstance(law, FrictionLaw):
        raise InputError(f"Chain: friction must be a law of ss.friction, or a list of them, got {shown(law)}")
    name = type(law).__name__
    why = ""
    if law.states:
        why = "has a state variable, which chains do not follow"
    elif not law.sticks:
        why = "never sticks, and chains need blocks that can rest"
    elif law.backward_from or law.ways[0] is not law.ways[1]:
        why = "differs with the direction of slip, which chains do not follow"
    elif len(law.pieces) > 1 and law.knot_variable == "rate":
        why = "has knots in slip rate, which chains do not follow"
    elif law.slips_in == "rad":
        why = "has numbers in rad, and blocks of a chain slip in m"
    if why:
        raise InputError(f"Chain: friction: {name} {why}; allowed: laws of slip and slip rate, such as Coulomb")
