"""How disturbances grow where a body bounces off a hard stop: by two runs, and by an own exact map from bounce to bounce."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.optimize import brentq

import stickslip as ss

STIFFNESS, DAMPING, STOP, BOUNCES, STEP = 100.0, 0.4, 0.05, 0.7, 4e-3
"""Of a mass of 1 kg whose spring is drawn to and fro at a rate of 1 m/s x sin: N/m, N s/m, m, share of the rate, s."""


def own_exponent(period: float, begin: float, lasts: float) -> float:
    """Return the exponent (1/s), by the exponential of the linear equation, and what a bounce makes of a disturbance.

    A bounce turns (x, v) into (-e x, -e v + (a' + e a) x / v), with the rate v and the acceleration a before it and a' behind it.
    """
    turn = 2.0 * math.pi / period
    paces = np.zeros((5, 5))  # of place, rate, sine, cosine and 1
    paces[0, 1], paces[2, 3], paces[3, 2] = 1.0, turn, -turn
    paces[1] = [-STIFFNESS, -DAMPING, 0.0, -STIFFNESS / turn, STIFFNESS / turn]
    whole = expm(paces * STEP)
    now, ahead, time, grown, found = np.array([0.0, 0.0, 0.0, 1.0, 1.0]), np.array([1.0, 0.0]), 0.0, 0.0, []
    while time < lasts:
        later = whole @ now
        if later[0] < STOP:
            now, ahead, time = later, whole[:2, :2] @ ahead, time + STEP
        else:
            high = float(brentq(lambda way, now=now: (expm(paces * way) @ now)[0] - STOP, 0.0, STEP, xtol=1e-13))
            part = expm(paces * high)
            now, ahead, time = part @ now, part[:2, :2] @ ahead, time + high
            met, before = float(now[1]), float((paces @ now)[1])
            now[:2] = STOP, -BOUNCES * met
            behind = float((paces @ now)[1])
            ahead = np.array([-BOUNCES * ahead[0], -BOUNCES * ahead[1] + (behind + BOUNCES * before) / met * ahead[0]])
        size = math.hypot(10.0 * ahead[0], ahead[1])
        grown, ahead = grown + math.log(size), ahead / size
        found.append((time, grown))
    times, growth = np.array(found).T
    return float(np.polyfit(times[times > begin], growth[times > begin], 1)[0])


@pytest.mark.parametrize("period", [0.55, 0.65], ids=["periodic", "chaotic"])
def test_bounces_off_a_stop_make_of_disturbances_what_an_own_map_does(period: float) -> None:
    """Over the same time, to half the standard error: 3 % of the exponent of the periodic motion, and 27 % of the chaotic one's."""
    body = ss.SpringBlock(1.0, STIFFNESS, 1e-9, damping=DAMPING, stop_ahead=STOP, restitution=BOUNCES)
    pull = ss.loading.Sinusoidal(mean=0.0, amplitude=1.0, period=period)
    found = ss.studies.lyapunov(ss.Problem(body, ss.friction.Coulomb(0.1, 0.1), pull_rate=pull, initial_load=0.0), 60.0, skip=10.0)
    own = own_exponent(period, 15.0, 60.0)
    assert abs(found.exponent - own) < 0.5 * found.error < 0.3 * abs(own)
    assert (own > 0.0) == (period == 0.65)
