"""Colours of whole numbers, which readers with any colour vision can tell apart, and jumps of curves."""

from __future__ import annotations

from itertools import combinations

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib.colors import to_rgb
from numpy.typing import NDArray

from stickslip.figures.sweeps.colours import FEW, shades
from stickslip.figures.sweeps.curves import jumps

Floats = NDArray[np.float64]

# What readers without one kind of cones see, in linear RGB: Machado, Oliveira & Fernandes 2009, severity 1.
VISIONS = {
    "usual": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
# Linear RGB to the cone responses of Oklab, and their cube roots to lightness and two contrasts: Ottosson 2020.
CONES = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
]
OPPONENT = [
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
]
# Differences below some 0.02 are invisible; colours of a key, far apart on a page, need several times as much.
LEAST = 0.095


def oklab(colours: list[str], vision: str) -> Floats:
    """Return lightness and the two contrasts of colours, as readers with this vision see them."""
    encoded = np.array([to_rgb(colour) for colour in colours])
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ np.array(VISIONS[vision]).T, 0.0, 1.0)
    return np.cbrt(seen @ np.array(CONES).T) @ np.array(OPPONENT).T


def least_distance(colours: list[str], vision: str) -> float:
    return min(float(np.linalg.norm(one - other)) for one, other in combinations(oklab(colours, vision), 2))


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("count", range(2, FEW + 1))
def test_readers_can_tell_the_colours_of_counts_apart(count: int, vision: str) -> None:
    assert least_distance(shades(count), vision) > LEAST


@pytest.mark.parametrize("count", range(3, FEW + 1))
def test_higher_counts_are_darker(count: int) -> None:
    assert (np.diff(oklab(shades(count), "usual")[:, 0]) < -0.02).all()


def test_the_measure_of_distance_finds_colours_that_are_too_close() -> None:
    usual = [mpl.colors.to_hex(colour) for colour in mpl.colormaps["viridis"](np.linspace(0.05, 0.95, FEW))]
    assert min(least_distance(usual, vision) for vision in VISIONS) < 0.6 * LEAST
    assert least_distance(["#009E73", "#A2A2A2"], "protanopia") < least_distance(["#009E73", "#A2A2A2"], "usual")


X = np.linspace(0.0, 1.0, 41)


@pytest.mark.parametrize(
    "smooth", [X, X**2, np.sin(7.0 * X), np.exp(5.0 * X), np.tanh(20.0 * (X - 0.5)), np.sqrt(X), np.ones(41), 1.0 / (0.05 + X)]
)
def test_smooth_curves_do_not_jump(smooth: Floats) -> None:
    assert not jumps(smooth).any()


@pytest.mark.parametrize("smooth", [np.zeros(41), X, np.sin(7.0 * X), X**2])
@pytest.mark.parametrize("place", [0, 1, 17, 38, 39])
@pytest.mark.parametrize("height", [-2.0, 2.0])
def test_a_step_is_a_jump_where_it_is(smooth: Floats, place: int, height: float) -> None:
    assert np.flatnonzero(jumps(smooth + height * (X[place] < X))).tolist() == [place]


def test_a_single_member_apart_jumps_on_both_sides() -> None:
    values = X.copy()
    values[20] += 3.0
    assert np.flatnonzero(jumps(values)).tolist() == [19, 20]


def test_noise_below_a_twentieth_of_the_range_is_no_jump() -> None:
    assert not jumps(X + np.where(np.arange(41) == 20, 0.04, 0.0)).any()


def test_missing_members_are_beside_no_jump() -> None:
    values = np.where(X > 0.5, 5.0, 0.0)
    values[20:22] = np.nan
    assert not jumps(values).any()
    assert not jumps(np.full(4, np.nan)).any()


def test_counts_jump_wherever_they_change() -> None:
    assert jumps(np.array([1.0, 1.0, 2.0, 2.0, np.nan, 3.0, 4.0]), whole=True).tolist() == [False, True, False, False, False, True]
