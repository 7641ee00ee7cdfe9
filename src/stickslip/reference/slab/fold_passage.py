"""Delay of a contact with little inertia at a fold of its resistance.

The slip rate obeys eps dv/dt = load - g(v), with a load that passes the fold at the rate b (Pa/s) and
g = g_fold + a (v - v_fold)^2 + ... near it (a = |g''| / 2, Pa s^2/m^2). With time in units of k = (eps^2 / (a b))^(1/3) s, the
scaled deviation from the fold obeys X' = -T - X^2. The solution that comes from the branch is X = -Ai'(-T) / Ai(-T), which diverges
at the first zero of the Airy function Ai, T = 2.338. Source: Haberman 1979, SIAM J. Appl. Math. 37, 69.
"""

from __future__ import annotations

AIRY_ZERO = 2.338107410459767
"""Magnitude of the first zero of the Airy function Ai."""


def fold_delay(inertia: float, curvature: float, load_rate: float) -> float:
    """Return the delay of a jump after the load passes the fold, in the limit of small inertia.

    Parameters
    ----------
    inertia : float
        Contact mass eps (Pa s^2/m, which is kg/m^2); for lagged friction, Z times the time of the lag.
    curvature : float
        |g''| at the fold (Pa s^2/m^2).
    load_rate : float
        Magnitude of the rate of change of the load at the fold (Pa/s).

    Returns
    -------
    float
        Delay (s).
    """
    return float(AIRY_ZERO * (inertia**2 / (0.5 * curvature * load_rate)) ** (1.0 / 3.0))
