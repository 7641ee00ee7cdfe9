"""Write the source text of a friction formula: its value, and the Taylor series of a contact that slips under it.

Each formula becomes straight-line code in C functions, which are compiled one by one when first needed:

prepare      fills `c` with the formula's constants and the values of its nodes at the reference point (slip x_ref, rate 0)
value        mu(x, s) - mu(x_ref, 0), and its derivatives with respect to s and x
state_value  mu(x, s, w) - mu(x_ref, 0, 0) and dw/dt of each state w, with their derivatives with respect to s, x and the states
rate_jet     massless contact, Z s + S mu(x, s) = L: the series of s, solved order by order (an index-1 system)
motion_jet   contact with mass, M s' = L - K q - Z s - S mu(x, s): the series of s
radii        how far mu may be from its value where a series starts, if slip and slip rate vary in complex discs (see `balls`)
balls        the same around any slip, slip rate and states, and for dw/dt of each
rate_jets, motion_jets, radii_in_lanes, values_in_lanes  the same for several runs side by side (see `simd`)

A jet writes the values of the nodes that `radii` needs right after the ORDER + 1 coefficients of its series, if there is room.

Friction is computed as a *difference* from the reference, node by node (sin(r+e) - sin(r), expm1, log1p ...), so that a contact
released at the very edge of equilibrium keeps its digits. Here s >= 0 is the magnitude of the slip rate, q its integral, and
x = x_start + chi q the slip that the law counts. The caller writes the series of states that follow from time alone behind that of
the load L. Time inside a piece is t = t0 + A eta + B eta^2 / 2, so dt/d eta = A + B eta. B is zero except next to a fold, where s
goes as a square root of time and eta is that root. A contact that leaves rest exactly at its strength has no net force by
definition, not by subtraction: the caller sets k[10] = 0, and k[11] to the step from static to sliding friction (times the normal
stress or force).
"""

from __future__ import annotations

from collections.abc import Callable

from stickslip.engine.formula_code.balls import Balls
from stickslip.engine.formula_code.recurrences import Recurrences
from stickslip.friction.formula import RATE, SLIP, STATES, Expression, depends_on

ORDER = 18
"""Order of the Taylor series, and therefore degree of the polynomials in the history."""

SIGNATURES = {
    "prepare": ("p[]", "x_ref", "c[]"),
    "value": ("c[]", "dx", "s", "out[]"),
    "state_value": ("c[]", "dx", "s", "states[]", "out[]"),
    "radii": ("c[]", "s[]", "k[]"),
    "balls": ("c[]", "s[]", "k[]"),
    "rate_jet": ("c[]", "k[]", "L[]", "s[]"),
    "motion_jet": ("c[]", "k[]", "L[]", "s[]"),
    "rate_jets": ("c[]", "k[]", "L[]", "s[]"),
    "motion_jets": ("c[]", "k[]", "L[]", "s[]"),
    "radii_in_lanes": ("c[]", "s[]", "k[]"),
    "values_in_lanes": ("c[]", "at[]", "out[]"),
}
"""Names of the functions and of their arguments: arrays of floats if marked by [], otherwise single floats."""

SIDE_BY_SIDE = {"rate_jets", "motion_jets", "radii_in_lanes", "values_in_lanes"}
"""Functions that work on lanes."""


class FormulaWriter(Recurrences):
    """Writes the functions of one formula as source text; the module's docstring lists them."""

    def __init__(
        self, formula: Expression, parameters: tuple[str, ...], order: int = ORDER, state_rates: tuple[Expression, ...] = ()
    ) -> None:
        super().__init__(formula, parameters, state_rates)
        self.limit = order
        self.balls = Balls(self, [formula, *state_rates])

    def prepare(self) -> list[str]:
        """Write the body of `prepare(p, x_ref, c)`."""
        return [f"c[{self.index[node]}] = {self.reference_value(node)}" for node in self.nodes]

    def value(self) -> list[str]:
        """Write the body of `value(c, dx, s, out)`; out receives mu minus its reference, then d mu/ds and d mu/dx."""
        body = ["s_0 = s", *self.order_zero(), *self.slopes(RATE, "d"), *self.slopes(SLIP, "f")]
        body += [
            f"out[0] = {self.difference(self.formula) or '0.0'}",
            f"out[1] = {self.slope(self.formula, RATE, 'd') or '0.0'}",
            f"out[2] = {self.slope(self.formula, SLIP, 'f') or '0.0'}",
        ]
        return body

    def state_value(self) -> list[str]:
        """Write the body of `state_value(c, dx, s, states, out)`; out receives the numbers of a `layout.LawValue`."""
        variables = ((RATE, "d"), (SLIP, "f"), *zip(self.states, ("y", "z", "g", "h"), strict=False))
        body = [f"{state.name} = states[{n}]" for n, state in enumerate(self.states)]
        body += ["s_0 = s", *self.order_zero()]
        for variable, tag in variables:
            body += self.slopes(variable, tag)
        most, trees = len(STATES), (self.formula, *self.state_rates)
        for i, tree in enumerate(trees):
            level = self.difference(tree) if i == 0 else self.coefficient(tree, 0)
            slopes = [self.slope(tree, variable, tag) for variable, tag in variables]
            places = [0, 1, 2, *range(3, 3 + most)]
            if i > 0:  # after mu and its slopes: all levels, all slopes by s, all by x, and the rows of those by the states
                n, first = i - 1, 3 + most
                places = [first + k * most + n for k in range(3)] + [first + (3 + n) * most + k for k in range(most)]
            body += [f"out[{place}] = {text or '0.0'}" for place, text in zip(places, (level, *slopes), strict=False)]
        return body

    @property
    def has_room_for_centres(self) -> bool:
        """True if the values that `radii` needs fit in the row after a series."""
        return len(self.balls.centres) <= self.limit + 1

    def centres(self) -> list[str]:
        """Write the values that `radii` needs right after the series, if there is room."""
        if not self.has_room_for_centres:
            return []
        return [f"s[{self.limit + 1 + j}] = {self.coefficient(node, 0)}" for j, node in enumerate(self.balls.centres)]

    def radii(self) -> list[str]:
        """Write the body of `radii(c, s, k)`: s is what a jet has written, and k holds the numbers of a `layout.Ball`."""
        if not self.has_room_for_centres:
            return self.around()
        own = {SLIP: "x_0", RATE: "s_0"}
        body = [
            f"{own.get(node) or self.coefficient(node, 0)} = s[{self.limit + 1 + j}]" for j, node in enumerate(self.balls.centres)
        ]
        return [*body, *self._radii()]

    def around(self) -> list[str]:
        """Write the body of `balls(c, s, k)`, which works out the values at the centre itself; `s` is not used."""
        most = len(STATES)
        centres = [f"{state.name} = k[{5 + 2 * most + n}]" for n, state in enumerate(self.states)]
        return [f"dx = k[{3 + 2 * most}]", f"s_0 = k[{4 + 2 * most}]", *centres, *self.order_zero(), *self._radii()]

    def _radii(self) -> list[str]:
        most = len(STATES)
        results = [
            f"k[{2 + most + i}] = {self.balls.radius(tree) or '0.0'}" for i, tree in enumerate((self.formula, *self.state_rates))
        ]
        radii = [f"r_{state.name} = k[{2 + n}]" for n, state in enumerate(self.states)]
        return ["r_slip = k[0]", "r_rate = k[1]", *radii, *self.balls.lines, *results]

    def given_states(self, k: int) -> list[str]:
        """Write the k-th coefficients of the states in the formula, which a jet finds behind the series of the load."""
        used = [(n, state) for n, state in enumerate(self.states) if depends_on(self.formula, state)]
        return [f"{self.coefficient(state, k)} = L[{(n + 1) * (self.limit + 1) + k}]" for n, state in used]

    def shares(self, unit: str) -> list[str]:
        """Write the factors with which the parts of friction enter the contact equation, which is divided to give `unit` to mu."""
        return [f"f{n} = -({factor} * {unit})" for n, factor in enumerate(self.parts(self.formula).values())]

    def less_friction(self, rest: str, k: int) -> str:
        """Write the k-th coefficient of the contact equation's right-hand side: `rest` minus friction."""
        for n, part in enumerate(self.parts(self.formula)):
            factor, name = self.series_of(part, k)
            if name != "0.0":
                rest = f"fused({factor} * f{n}, {name}, {rest})"
        return rest

    def rate_jet(self) -> list[str]:
        """Write the body of `rate_jet(c, k, L, s)`, for a massless contact.

        k holds the numbers of `engine.state.layout.SeriesInput`, L the series of the load and those of the states that follow from
        time; s receives the series of the rate. A and B of the text include the factor chi, so that the integral of s is that of
        the law's slip. If friction depends on the rate, k[9] must already solve the contact equation.
        """
        body = ["Z = k[0]", "S = k[1]", "A = k[2] * k[3]", "B = k[2] * k[4]", "dx = k[5]", "offset = k[6]"]
        body += self.given_states(0)
        implicit = self.rate_dependent[self.formula]
        if implicit:
            body += ["s_0 = k[9]", *self.order_zero(), *self.slopes(RATE, "d")]
            body += [f"resistance = 1.0 / (Z + S * {self.slope(self.formula, RATE, 'd')})"]
        else:
            body += [*self.order_zero(), "resistance = 1.0 / Z"]
            body += [f"s_0 = k[10] * (L[0] - S * ({self.difference(self.formula) or '0.0'} + offset)) * resistance"]
        body += ["s[0] = s_0", *self.before_orders("A", "B"), *self.shares("S * resistance"), *self.centres()]
        for k in range(1, self.limit + 1):
            body += [f"x_{k} = {_integral('s', k)}", *self.given_states(k)]
            self.pending_rate = k
            body += self.order(k)
            body.append(f"s_{k} = {self.less_friction(f'L[{k}] * resistance', k)}")
            self.pending_rate = None
            for node in self.dynamic:
                if self.rate_dependent[node]:
                    body.append(f"n{self.index[node]}_{k} += {self.slope(node, RATE, 'd')} * s_{k}")
            body += [*self.weights(k), f"s[{k}] = s_{k}"]
        return body

    def motion_jet(self) -> list[str]:
        """Write the body of `motion_jet(c, k, L, s)`, for a contact with mass: M ds/dt = L - K q - Z s - S mu.

        The arguments are those of `rate_jet`.
        """
        body = ["Z = k[0]", "S = k[1]", "chi = k[2]", "A = k[3]", "B = k[4]", "dx = k[5]", "offset = k[6]", "inertia = 1.0 / k[7]"]
        body += ["K = k[8]", "s_0 = k[9]", *self.given_states(0), *self.order_zero(), "s[0] = s_0"]
        force = f"L[0] - Z * s_0 - S * ({self.difference(self.formula) or '0.0'} + offset)"
        body += [f"a_0 = (k[10] * ({force}) + k[11]) * inertia", *self.before_orders("chi * A", "chi * B")]
        body += [*self.shares("S * inertia"), *self.centres()]
        for k in range(1, self.limit + 1):
            body += [f"q_{k} = {_integral('s', k)}", f"s_{k} = {_integral('a', k)}"]
            body.append(f"s[{k}] = s_{k}")
            if k == self.limit:
                break
            body += [f"x_{k} = chi * q_{k}", *self.given_states(k), *self.order(k), *self.weights(k)]
            body.append(f"a_{k} = {self.less_friction(f'(L[{k}] - K * q_{k} - Z * s_{k}) * inertia', k)}")
        return body

    def statements(self, part: str) -> list[str]:
        """Return the body of one of the functions in SIGNATURES, as assignments.

        They are nearly valid C, too, and benchmarks/c_peer.py turns them into C.
        """
        write: dict[str, Callable[[], list[str]]] = {
            "prepare": self.prepare,
            "value": self.value,
            "state_value": self.state_value,
            "radii": self.radii,
            "balls": self.around,
            "radii_in_lanes": self.radii,
            "values_in_lanes": lambda: ["dx = at[0]", "s = at[1]", *self.value()],
            "rate_jet": self.rate_jet,
            "motion_jet": self.motion_jet,
            "rate_jets": self.rate_jet,
            "motion_jets": self.motion_jet,
        }
        return write[part]()


def _integral(name: str, k: int) -> str:
    """Write the k-th coefficient of the integral of a series over dt = (A + B eta) d eta.

    The factors A / k and B / k come first, because they do not depend on the series and can be computed ahead.
    """
    old = f" + {1.0 / k!r} * B * {name}_{k - 2}" if k > 1 else ""
    return f"{1.0 / k!r} * A * {name}_{k - 1}{old}"
