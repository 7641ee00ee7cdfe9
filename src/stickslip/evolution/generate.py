"""Write the compiled form of a friction formula: its value and the Taylor series of the contact that slips under it.

Each formula becomes a small module of straight-line code with four C functions (`SIGNATURES`):

prepare    fills `c` with the formula's constants and its nodes at the reference point (slip x_ref, rate 0)
value      mu(x, s) - mu(x_ref, 0) with its derivatives with respect to s and x
rate_jet   massless contact, Z s + S mu(x, s) = L: the series of s, solved order by order (an index-1 system)
motion_jet contact with mass, M s' = L - K q - Z s - S mu(x, s): the series of s

Friction is kept as a *difference* from the reference, node by node (sin(r+e) - sin(r), expm1, log1p ...), so that a contact
released from the very edge of equilibrium keeps its digits. s >= 0 is the magnitude of the slip rate, q its integral, and
x = x_start + chi q the slip that the law counts. Time inside a piece is t = t0 + A eta + B eta^2 / 2, dt/d eta = A + B eta: B is
zero except where a piece ends or starts at a fold, where s goes as a square root of time and eta is that root. A contact that
leaves rest exactly at its strength has no net force by definition, not by subtraction: k[10] = 0 says so, k[11] is the step
from static to sliding friction.
"""

from __future__ import annotations

from stickslip.friction.expression import RATE, SLIP, Expression, depends_on, nodes_of

ORDER = 18
"""Order of the Taylor series, and so of the history's polynomials."""

MODULE_HEADER = '''"""Generated from the friction formula {formula}; do not edit."""

from math import asinh, cos, exp, expm1, log, log1p, sin, sqrt, tanh

from numba import cfunc, njit, types

_array = types.CPointer(types.float64)
_options = dict(cache=True, nopython=True, error_model="numpy", fastmath={{"contract"}})


@njit(error_model="numpy")
def power_difference(base, step, exponent):
    if base > 0.0 and step > -base:
        return base**exponent * expm1(exponent * log1p(step / base))
    return (base + step) ** exponent - base**exponent


@njit(error_model="numpy")
def arcsinh_difference(base, step):
    root, other = sqrt(1.0 + base * base), sqrt(1.0 + (base + step) * (base + step))
    return asinh(step * (root - base * (2.0 * base + step) / (root + other)))

'''


def balanced(terms: list[str]) -> str:
    """Sum of terms as a balanced tree: shorter dependency chains than a running sum, and smaller rounding error."""
    if len(terms) == 1:
        return terms[0]
    half = len(terms) // 2
    return f"({balanced(terms[:half])} + {balanced(terms[half:])})"


def describe(node: Expression) -> str:
    """The formula in ordinary notation."""
    signs = {"add": "+", "sub": "-", "mul": "*", "div": "/", "pow": "**"}
    if node.operation in signs:
        left, right = (describe(argument) for argument in node.arguments)
        return f"({left} {signs[node.operation]} {right})"
    if node.arguments:
        return f"{node.operation}({describe(node.arguments[0])})"
    return node.name or repr(node.value)


class FormulaWriter:
    """Turns one formula into source text; see the module's docstring for what is written."""

    def __init__(self, formula: Expression, parameters: tuple[str, ...], order: int = ORDER) -> None:
        self.formula, self.parameters, self.limit = formula, parameters, order
        self.nodes = self._with_companions(formula)
        self.index = {node: i for i, node in enumerate(self.nodes)}
        self.varies = {node: depends_on(node, SLIP) or depends_on(node, RATE) for node in self.nodes}
        self.rate_dependent = {node: depends_on(node, RATE) for node in self.nodes}
        self.dynamic = [n for n in self.nodes if self.varies[n] and n not in (SLIP, RATE)]
        self.pending_rate: int | None = None
        self.size = len(self.nodes) + 1

    @staticmethod
    def _with_companions(formula: Expression) -> list[Expression]:
        """Nodes in order of computation, with the partner that a recurrence needs (cos for sin, and so on)."""
        found: dict[Expression, None] = {}
        for node in nodes_of(formula):
            argument = node.arguments[0] if node.arguments else node
            if node.operation in ("sin", "cos"):
                found.update(dict.fromkeys((Expression("sin", (argument,)), Expression("cos", (argument,)))))
            elif node.operation == "arcsinh":
                found.update(dict.fromkeys(nodes_of(Expression("sqrt", (1.0 + argument * argument,)))))
            found[node] = None
            if node.operation == "tanh":
                found[node * node] = None
        found.setdefault(SLIP)
        found.setdefault(RATE)
        return list(found)

    # ---- names --------------------------------------------------------------------------------------------------------------

    def reference(self, node: Expression) -> str:
        return f"c[{self.index[node]}]"

    def coefficient(self, node: Expression, k: int) -> str | None:
        """Name of the k-th Taylor coefficient of a node, or None where it is identically zero."""
        if not self.varies[node]:
            return self.reference(node) if k == 0 else None
        if node == RATE:
            return None if k == self.pending_rate else f"s_{k}"
        return f"x_{k}" if node == SLIP else f"n{self.index[node]}_{k}"

    def difference(self, node: Expression) -> str | None:
        if not self.varies[node]:
            return None
        return {SLIP: "dx", RATE: "s_0"}.get(node, f"e{self.index[node]}")

    def slope(self, node: Expression, variable: Expression, tag: str) -> str | None:
        if not depends_on(node, variable):
            return None
        return "1.0" if node == variable else f"{tag}{self.index[node]}"

    def sum_of(self, terms: list[str]) -> str:
        return balanced(terms) if terms else "0.0"

    def products(self, a: Expression, b: Expression, pairs: list[tuple[int, int]]) -> list[str]:
        names = [(self.coefficient(a, i), self.coefficient(b, j)) for i, j in pairs]
        return [f"{x} * {y}" for x, y in names if x is not None and y is not None]

    # ---- order zero ---------------------------------------------------------------------------------------------------------

    def reference_value(self, node: Expression) -> str:
        """The node at the reference point, for `prepare`."""
        arguments = [self.reference(argument) for argument in node.arguments]
        signs = {"add": "+", "sub": "-", "mul": "*", "div": "/", "pow": "**"}
        if node.operation in signs:
            return f"{arguments[0]} {signs[node.operation]} {arguments[1]}"
        if node.arguments:
            return f"{'asinh' if node.operation == 'arcsinh' else node.operation}({arguments[0]})"
        if node.operation == "parameter":
            return f"p[{self.parameters.index(node.name)}]"
        return {"slip": "x_ref", "rate": "0.0"}.get(node.operation, repr(node.value))

    def order_zero(self) -> list[str]:
        """Differences from the reference and values of every node at dx, s_0."""
        lines = [f"x_0 = {self.reference(SLIP)} + dx"]
        halves: set[Expression] = set()
        for node in self.dynamic:
            i = self.index[node]
            if node.operation in ("sin", "cos") and node.arguments[0] not in halves:
                halves.add(node.arguments[0])
                j = self.index[node.arguments[0]]
                half = f"0.5 * {self.difference(node.arguments[0])}"
                lines += [f"h{j} = sin({half})", f"g{j} = 2.0 * h{j} * cos({half})", f"h{j} = 2.0 * h{j} * h{j}"]
            lines.append(f"e{i} = {self._difference_rule(node)}")
            lines.append(f"n{i}_0 = {self._value_rule(node)}")
        return lines

    def _value_rule(self, node: Expression) -> str:
        """The node's value: from its arguments where that is cheap, since reference plus difference loses digits of small values."""
        sign = {"add": "+", "sub": "-", "mul": "*", "div": "/"}.get(node.operation)
        if sign is None:
            return f"{self.reference(node)} + e{self.index[node]}"
        left, right = (self.coefficient(argument, 0) for argument in node.arguments)
        return f"{left} {sign} {right}"

    def _difference_rule(self, node: Expression) -> str:
        a = node.arguments[0]
        r, ra, ea = self.reference(node), self.reference(a), self.difference(a)
        if node.operation in ("add", "sub", "mul", "div"):
            b = node.arguments[1]
            rb, eb = self.reference(b), self.difference(b)
            if node.operation == "add":
                return " + ".join(e for e in (ea, eb) if e)
            if node.operation == "sub":
                return f"{ea or ''}{f' - {eb}' if eb else ''}"
            if node.operation == "mul":
                return " + ".join(t for t in (ea and f"{ea} * {rb}", eb and f"({ra}{f' + {ea}' if ea else ''}) * {eb}") if t)
            numerator = f"{ea or ''}{f' - {r} * {eb}' if eb else ''}"
            return f"({numerator}) / ({rb}{f' + {eb}' if eb else ''})"
        if node.operation in ("sin", "cos"):
            j = self.index[a]
            sine, cosine = (self.reference(Expression(name, (a,))) for name in ("sin", "cos"))
            return f"{cosine} * g{j} - {sine} * h{j}" if node.operation == "sin" else f"-{sine} * g{j} - {cosine} * h{j}"
        return {
            "exp": f"{r} * expm1({ea})",
            "log": f"log1p({ea} / {ra})",
            "sqrt": f"{ea} / (sqrt({ra} + {ea}) + {r})",
            "tanh": f"tanh({ea}) * (1.0 - {r} * {r}) / (1.0 + {r} * tanh({ea}))",
            "arcsinh": f"arcsinh_difference({ra}, {ea})",
            "pow": f"power_difference({ra}, {ea}, {self.reference(node.arguments[-1])})",
        }[node.operation]

    def slopes(self, variable: Expression, tag: str) -> list[str]:
        """First derivatives of the nodes with respect to SLIP or RATE."""
        lines = []
        for node in self.dynamic:
            if not depends_on(node, variable):
                continue
            a = node.arguments[0]
            value, a0, da = self.coefficient(node, 0), self.coefficient(a, 0), self.slope(a, variable, tag)
            if node.operation in ("add", "sub", "mul", "div"):
                b = node.arguments[1]
                b0, db = self.coefficient(b, 0), self.slope(b, variable, tag)
                rule = {
                    "add": " + ".join(d for d in (da, db) if d),
                    "sub": f"{da or ''}{f' - {db}' if db else ''}",
                    "mul": " + ".join(t for t in (da and f"{da} * {b0}", db and f"{a0} * {db}") if t),
                    "div": f"({da or ''}{f' - {value} * {db}' if db else ''}) / {b0}",
                }[node.operation]
            else:
                partner = {"sin": "cos", "cos": "sin"}.get(node.operation)
                other = self.coefficient(Expression(partner, (a,)), 0) if partner else ""
                rule = {
                    "sin": f"{other} * {da}",
                    "cos": f"-{other} * {da}",
                    "exp": f"{value} * {da}",
                    "log": f"{da} / {a0}",
                    "sqrt": f"{da} / (2.0 * {value})",
                    "tanh": f"(1.0 - {value} * {value}) * {da}",
                    "arcsinh": f"{da} / sqrt(1.0 + {a0} * {a0})",
                    "pow": f"{self.reference(node.arguments[-1])} * {value} / {a0} * {da}",
                }[node.operation]
            lines.append(f"{tag}{self.index[node]} = {rule}")
        return lines

    # ---- higher orders ------------------------------------------------------------------------------------------------------

    def order(self, k: int) -> list[str]:
        return [f"n{self.index[node]}_{k} = {self._recurrence(node, k)}" for node in self.dynamic]

    def weights(self, k: int) -> list[str]:
        """k a_k of every argument of a function: shared by the recurrences of higher order."""
        arguments = {n.arguments[0] for n in self.dynamic if n.operation in ("sin", "cos", "exp", "tanh")}
        arguments |= {n for n in self.dynamic if n.operation in ("log", "arcsinh")}
        return [f"w{self.index[a]}_{k} = {k}.0 * {self.coefficient(a, k)}" for a in sorted(arguments, key=self.index.__getitem__)]

    def _weighted(self, a: Expression, b: Expression, k: int) -> str:
        """(1/k) sum over 0 < j < k of j a_j b_(k-j)."""
        terms = [f"w{self.index[a]}_{j} * {self.coefficient(b, k - j)}" for j in range(1, k)]
        return f" + {1.0 / k!r} * {self.sum_of(terms)}" if terms else ""

    def _recurrence(self, node: Expression, k: int) -> str:
        a = node.arguments[0]
        ak = self.coefficient(a, k) or "0.0"
        if node.operation in ("add", "sub"):
            bk = self.coefficient(node.arguments[1], k) or "0.0"
            return f"{ak} {'+' if node.operation == 'add' else '-'} {bk}"
        if node.operation == "mul":
            return self.sum_of(self.products(a, node.arguments[1], [(j, k - j) for j in range(k + 1)]))
        if node.operation == "div":
            b = node.arguments[1]
            terms = self.products(b, node, [(j, k - j) for j in range(1, k + 1)])
            return f"({ak} - {self.sum_of(terms)}) / {self.coefficient(b, 0)}"
        if node.operation == "sqrt":
            terms = self.products(node, node, [(j, k - j) for j in range(1, k)])
            return f"({ak} - {self.sum_of(terms)}) / (2.0 * {self.coefficient(node, 0)})"
        if node.operation == "pow":
            exponent = self.reference(node.arguments[1])
            factors = [(j, self.coefficient(a, k - j), self.coefficient(node, j)) for j in range(k)]
            terms = [f"({k - j}.0 * {exponent} - {j}.0) * {x} * {y}" for j, x, y in factors if x is not None]
            return f"{self.sum_of(terms)} / ({k}.0 * {self.coefficient(a, 0)})"
        sine, cosine = Expression("sin", (a,)), Expression("cos", (a,))
        if node.operation == "sin":
            return f"{ak} * {self.coefficient(cosine, 0)}" + self._weighted(a, cosine, k)
        if node.operation == "cos":
            return f"-({ak} * {self.coefficient(sine, 0)}" + self._weighted(a, sine, k) + ")"
        if node.operation == "exp":
            return f"{ak} * {self.coefficient(node, 0)}" + self._weighted(a, node, k)
        if node.operation == "log":
            return f"({ak} - (0.0{self._weighted(node, a, k)})) / {self.coefficient(a, 0)}"
        if node.operation == "tanh":
            square = node * node
            return f"{ak} * (1.0 - {self.coefficient(square, 0)}) - (0.0{self._weighted(a, square, k)})"
        root = Expression("sqrt", (1.0 + a * a,))  # arcsinh
        return f"({ak} - (0.0{self._weighted(node, root, k)})) / {self.coefficient(root, 0)}"

    # ---- the four functions -------------------------------------------------------------------------------------------------

    def prepare(self) -> str:
        body = [f"c[{self.index[node]}] = {self.reference_value(node)}" for node in self.nodes]
        return _function("prepare", "p, x_ref, c", "_array, types.float64, _array", body)

    def value(self) -> str:
        body = ["s_0 = s", *self.order_zero(), *self.slopes(RATE, "d"), *self.slopes(SLIP, "f")]
        body += [
            f"out[0] = {self.difference(self.formula) or '0.0'}",
            f"out[1] = {self.slope(self.formula, RATE, 'd') or '0.0'}",
            f"out[2] = {self.slope(self.formula, SLIP, 'f') or '0.0'}",
        ]
        return _function("value", "c, dx, s, out", "_array, types.float64, types.float64, _array", body)

    def rate_jet(self) -> str:
        """Massless contact. k is laid out by `stickslip.evolution.layout`; L holds the load's series; s receives the rate's."""
        body = ["Z = k[0]", "S = k[1]", "A = k[2] * k[3]", "B = k[2] * k[4]", "dx = k[5]", "offset = k[6]"]
        implicit = self.rate_dependent[self.formula]
        if implicit:
            body += ["s_0 = k[9]", *self.order_zero(), *self.slopes(RATE, "d")]
            body += [f"resistance = 1.0 / (Z + S * {self.slope(self.formula, RATE, 'd')})"]
        else:
            body += [*self.order_zero(), "resistance = 1.0 / Z"]
            body += [f"s_0 = k[10] * (L[0] - S * ({self.difference(self.formula) or '0.0'} + offset)) * resistance"]
        body += ["s[0] = s_0"]
        for k in range(1, self.limit + 1):
            body.append(f"x_{k} = {1.0 / k!r} * (A * s_{k - 1}{f' + B * s_{k - 2}' if k > 1 else ''})")
            self.pending_rate = k
            body += self.order(k)
            friction = self.coefficient(self.formula, k)
            body.append(f"s_{k} = (L[{k}]{f' - S * {friction}' if friction else ''}) * resistance")
            self.pending_rate = None
            for node in self.dynamic:
                if self.rate_dependent[node]:
                    body.append(f"n{self.index[node]}_{k} += {self.slope(node, RATE, 'd')} * s_{k}")
            body += [*self.weights(k), f"s[{k}] = s_{k}"]
        return _function("rate_jet", "c, k, L, s", "_array, _array, _array, _array", body)

    def motion_jet(self) -> str:
        """Contact with mass: M ds/dt = L - K q - Z s - S mu. Arguments as for `rate_jet`."""
        body = ["Z = k[0]", "S = k[1]", "chi = k[2]", "A = k[3]", "B = k[4]", "dx = k[5]", "offset = k[6]", "inertia = 1.0 / k[7]"]
        body += ["K = k[8]", "s_0 = k[9]", *self.order_zero(), "s[0] = s_0"]
        force = f"L[0] - Z * s_0 - S * ({self.difference(self.formula) or '0.0'} + offset)"
        body += [f"a_0 = (k[10] * ({force}) + k[11]) * inertia"]
        for k in range(1, self.limit + 1):
            body.append(f"q_{k} = {1.0 / k!r} * (A * s_{k - 1}{f' + B * s_{k - 2}' if k > 1 else ''})")
            body.append(f"s_{k} = {1.0 / k!r} * (A * a_{k - 1}{f' + B * a_{k - 2}' if k > 1 else ''})")
            body.append(f"s[{k}] = s_{k}")
            if k == self.limit:
                break
            body += [f"x_{k} = chi * q_{k}", *self.order(k), *self.weights(k)]
            friction = self.coefficient(self.formula, k)
            force = f"L[{k}] - K * q_{k} - Z * s_{k}{f' - S * {friction}' if friction else ''}"
            body.append(f"a_{k} = ({force}) * inertia")
        return _function("motion_jet", "c, k, L, s", "_array, _array, _array, _array", body)

    def module(self) -> str:
        header = MODULE_HEADER.format(formula=describe(self.formula))
        return header + "\n\n".join((self.prepare(), self.value(), self.rate_jet(), self.motion_jet()))


def _function(name: str, arguments: str, signature: str, body: list[str]) -> str:
    lines = "\n".join(f"    {line}" for line in body)
    return f"@cfunc(types.void({signature}), **_options)\ndef {name}({arguments}):\n{lines}\n"
