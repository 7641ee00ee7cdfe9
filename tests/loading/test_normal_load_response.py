"""How steady sliding answers a small change of the normal force: the linear response of a block in closed form.

With k, m, S the stiffness, mass and normal force, V the slip rate and c = V/D, both evolution laws linearise to

    dw = -(c dv/V + (alpha/b) s dS/S) / (s + c),    (m s^2 + k + S s/V (a - b c/(s + c))) du = -(mu - alpha s/(s + c)) dS

(Linker & Dieterich 1992, J. Geophys. Res. 97, 4923, eqs (4), (5) for the friction; s is the Laplace variable). The denominator has
no alpha: the critical stiffness S (b - a)/D (1 + m V^2/(a S D)) is that of a constant normal force.
"""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.loading import LoadingHistory, Sinusoidal, Steps

REFERENCE, A, B, DISTANCE, PULL, NORMAL, MASS = 0.6, 0.01, 0.015, 1e-5, 1e-6, 1e6, 1e3
SMALL = 1e-5
"""Change of the normal force (1): the response is linear to about 60 times that share, and symmetric differences to its square."""
RENEWAL = PULL / DISTANCE
CRITICAL = NORMAL * (B - A) / DISTANCE * (1.0 + MASS * PULL**2 / (A * NORMAL * DISTANCE))


def polynomials(stiffness: float, coupling: float) -> tuple[np.ndarray, np.ndarray]:
    """Return numerator and denominator of du/dS, in powers of s, highest first; both times (s + c)."""
    above = -np.array([REFERENCE - coupling, REFERENCE * RENEWAL])
    viscous = NORMAL / PULL
    below = np.array([MASS, MASS * RENEWAL + viscous * A, stiffness + viscous * (A - B) * RENEWAL, stiffness * RENEWAL])
    return above, below


def slip_response(pressed: object, stiffness: float, coupling: float, evolution: str, times: np.ndarray) -> np.ndarray:
    """Return the slip of a run beyond steady sliding, per relative change of the normal force, by symmetric differences."""
    body = ss.SpringBlock(mass=MASS, stiffness=stiffness, normal_force=NORMAL)
    law = ss.friction.RateAndState(REFERENCE, A, B, DISTANCE, PULL, evolution, coupling)
    ends = []
    for sign in (1.0, -1.0):
        history: LoadingHistory = pressed(sign * SMALL)  # type: ignore[operator]
        run = ss.simulate(ss.Problem(body, law, pull_rate=PULL, normal_load=history), float(times[-1]), rtol=1e-11)
        ends.append(run.slip(times))
    return np.asarray((ends[0] - ends[1]) / (2.0 * SMALL))


@pytest.mark.parametrize("evolution", ["ageing", "slip"])
@pytest.mark.parametrize("coupling", [0.0, 0.3])
@pytest.mark.parametrize("ratio", [0.7, 1.0, 1.3])
def test_a_small_step_rings_as_the_poles_say_and_keeps_its_size_at_the_critical_stiffness(
    ratio: float, coupling: float, evolution: str
) -> None:
    """To 1e-5 of its size over two periods, below, at and above the critical stiffness; growth is 0 there to 1e-9 of a period."""
    above, below = polynomials(ratio * CRITICAL, coupling)
    poles = np.roots(below)
    ringing = poles[np.argmax(poles.imag)]
    if ratio == 1.0:
        assert abs(ringing.real) < 1e-9 * ringing.imag
    assert np.sign(round(ringing.real / abs(ringing), 9)) == np.sign(1.0 - ratio)
    times = np.linspace(0.05, 2.0, 60) * 2.0 * np.pi / ringing.imag
    # a step of size NORMAL is NORMAL/s; its response is the sum of residues at the poles and at 0
    residues = [NORMAL * np.polyval(above, pole) / (pole * np.polyval(np.polyder(below), pole)) for pole in poles]
    still = NORMAL * above[-1] / below[-1]
    expected = still + sum(size * np.exp(pole * times) for size, pole in zip(residues, poles, strict=True)).real
    found = slip_response(
        lambda by: Steps([0.0, 1e-9], [NORMAL, NORMAL * (1.0 + by)]), ratio * CRITICAL, coupling, evolution, times
    )
    assert found == pytest.approx(expected, abs=1e-5 * np.abs(expected).max(), rel=0.0)


@pytest.mark.parametrize("coupling", [0.0, 0.3])
@pytest.mark.parametrize("turns", [0.1, 1.0, 10.0])
def test_a_small_tide_of_the_normal_force_moves_slip_by_the_transfer_function(turns: float, coupling: float) -> None:
    """Amplitude and phase to 1e-5, at frequencies of `turns` c, where the rock sticks to its rate: a stiff spring, 5 critical ones.

    From b > a and alpha = mu - 0.3 on, slow tides press slip down, and fast ones are damped by the coupling.
    """
    stiffness, frequency = 5.0 * CRITICAL, turns * RENEWAL
    above, below = polynomials(stiffness, coupling)
    poles, size = np.roots(below), NORMAL * frequency  # sin(w t) is w/(s^2 + w^2)
    times = np.linspace(0.05, 2.0, 60) * 2.0 * np.pi / frequency
    places = [*poles, 1j * frequency, -1j * frequency]
    whole = np.polymul(below, [1.0, 0.0, frequency**2])
    expected = sum(size * np.polyval(above, p) / np.polyval(np.polyder(whole), p) * np.exp(p * times) for p in places).real
    found = slip_response(lambda by: Sinusoidal(NORMAL, by * NORMAL, 2.0 * np.pi / frequency), stiffness, coupling, "ageing", times)
    assert found == pytest.approx(expected, abs=1e-5 * np.abs(expected).max(), rel=0.0)


@pytest.mark.parametrize("coupling", [0.0, 0.25])
def test_at_a_held_slip_rate_the_slip_law_forgets_a_step_exponentially_with_slip(coupling: float) -> None:
    """A spring of 1e5 critical stiffnesses holds the rate: w = -(alpha/b) ln(S+/S-) exp(-c t), for a step of any size."""
    body = ss.SpringBlock(mass=MASS, stiffness=1e5 * CRITICAL, normal_force=NORMAL)
    law = ss.friction.RateAndState(REFERENCE, A, B, DISTANCE, PULL, "slip", coupling)
    history = Steps([0.0, 1.0], [NORMAL, 1.3 * NORMAL])
    run = ss.simulate(ss.Problem(body, law, pull_rate=PULL, normal_load=history), 11.5)
    since = np.array([1.0, 3.0, 10.0])
    expected = REFERENCE - coupling * np.log(1.3) * np.exp(-RENEWAL * since)
    assert run.traction(1.0 + since) / (1.3 * NORMAL) == pytest.approx(expected, abs=1e-4)
