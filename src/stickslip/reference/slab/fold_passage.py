"""How long a contact with a little inertia stays beyond a fold of its resistance.

eps dv/dt = load - g(v), with a load that passes the fold at the rate b (Pa/s) and g = g_fold + a (v - v_fold)^2 + ... near it
(a = |g''| / 2, Pa s^2/m^2). In units of k = (eps^2 / (a b))^(1/3) s the deviation is X' = -T - X^2, whose solution from the
branch is Ai'/Ai of -T: it leaves at the first zero of the Airy function, T = 2.338. Haberman 1979, SIAM J. Appl. Math. 37, 69.
"""

from __future__ import annotations

AIRY_ZERO = 2.338107410459767
"""Magnitude of the first zero of the Airy function Ai."""


def fold_delay(inertia: float, curvature: float, load_rate: float) -> float:
    """Delay (s) of the jump behind the moment at which the load passes the fold, in the limit of small inertia.

    inertia: eps (Pa s^2/m, which is kg/m^2; Z times the time for a lag); curvature: |g''| at the fold (Pa s^2/m^2);
    load_rate: magnitude of the load's rate of change there (Pa/s).
    """
    return float(AIRY_ZERO * (inertia**2 / (0.5 * curvature * load_rate)) ** (1.0 / 3.0))
