"""Root finding in a bracket: Newton's method for smooth monotone functions, Chandrupatla's for functions that may jump."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Sequence

_NEAR = 1e-8
"""After a relative step smaller than this, Newton's method needs only one more: it converges quadratically."""


def bracketed_newton(
    function: Callable[[float], tuple[float, float]], low: float, high: float, start: float, rising: bool
) -> float:
    """Return the root, to rounding, of a function that returns its value and its slope and is monotone between low and high.

    `rising` is True if the value is negative at low and positive at high. The method bisects if Newton's step leaves the bracket or
    hardly gains, and stops if a step no longer reduces the value: only rounding is then left.
    """
    x, last = start, high - low
    value, slope = function(x)
    for _ in range(200):
        if value == 0.0 or math.nextafter(low, high) >= high:
            break
        low, high = (low, x) if (value > 0.0) == rising else (x, high)
        step = -value / slope if slope else math.inf
        newton = low < x + step < high and (abs(step) <= 0.5 * last or abs(step) <= _NEAR * abs(x))
        if not newton:
            step = 0.5 * (low + high) - x
        last, x, before = abs(step), x + step, value
        value, slope = function(x)
        if newton and last <= _NEAR * abs(x) and abs(value) >= 0.5 * abs(before):
            break
    return x


def sign_change(function: Callable[[float], float], low: float, high: float) -> float:
    """Return the place, to rounding, where a function changes between negative and not negative.

    The function may jump there, or be infinite. The result is the end of the last bracket with a value that is not negative.
    Chandrupatla's method (1997, Adv. Eng. Softw. 28, 145) interpolates by an inverse quadratic where the function is nearly
    straight, and bisects elsewhere.
    """
    return sign_changes(lambda wanted: [function(x) for _, x in wanted], [(low, high)])[0]


def sign_changes(
    function: Callable[[list[tuple[int, float]]], list[float]], brackets: Sequence[tuple[float, float]]
) -> list[float]:
    """Return the same as `sign_change` for each of several brackets.

    The function is called with pairs of the number of a bracket and a place in it, and returns its value at each.
    """
    searches = [_sign_change(low, high) for low, high in brackets]
    wanted = {k: next(search) for k, search in enumerate(searches)}
    found = dict.fromkeys(range(len(searches)), math.nan)
    while wanted:
        values = function(list(wanted.items()))
        for k, value in zip(list(wanted), values, strict=True):
            try:
                wanted[k] = searches[k].send(value)
            except StopIteration as ended:
                found[k] = ended.value
                del wanted[k]
    return list(found.values())


def _sign_change(low: float, high: float) -> Generator[float, float, float]:
    """Yield places where the search needs the function, receive its values there, and return the place of the change."""
    a, b, c = high, low, high
    fa, fb = (yield a), (yield b)
    fc, t = fa, 0.5
    for _ in range(200):
        x = a + t * (b - a)
        if not min(a, b) < x < max(a, b):
            break
        fx = yield x
        if (fx < 0.0) == (fa < 0.0):
            c, fc = a, fa
        else:
            c, b, fc, fb = b, a, fb, fa
        a, fa = x, fx
        if fa == 0.0 or abs(b - a) <= 4.0 * math.ulp(abs(a)):
            break
        t = _next_share((a, fa), (b, fb), (c, fc))
    return b if fa < 0.0 else a


def _next_share(*points: tuple[float, float]) -> float:
    """Return the next place to examine, as a share of the way from a to b; `points` are a, b and c with the values there."""
    (a, fa), (b, fb), (c, fc) = points
    if not (math.isfinite(fa) and math.isfinite(fb) and math.isfinite(fc)) or fc in (fa, fb) or fa == fb:
        return 0.5
    xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
    if not (phi**2 < xi and (1.0 - phi) ** 2 < 1.0 - xi):
        return 0.5
    share = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
    least = 2.0 * math.ulp(abs(a)) / abs(b - a)
    return min(max(share, least), 1.0 - least)
