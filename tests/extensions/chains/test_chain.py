"""What a user states of a chain: numbers of blocks, draws, springs, and bad input in one line."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from scipy import sparse

import stickslip as ss
from stickslip.extensions.chains.couplings import Couplings

LAW = ss.friction.Coulomb(static=1.0, dynamic=0.8)
GIVEN = {"blocks": 4, "mass": 1.0, "coupling": 10.0, "stiffness": 1.0, "normal_force": 1.0, "pull_rate": 1e-3}


def chain(**changed: object) -> ss.Chain:
    return ss.Chain(**({"friction": LAW} | GIVEN | changed))


def matrix_of(rows: Couplings) -> np.ndarray:
    """Return the matrix of springs, walls on its diagonal."""
    found = np.diag(rows.walls)
    for j in range(len(rows.walls)):
        for place in range(rows.starts[j], rows.starts[j + 1]):
            found[j, rows.neighbours[place]] += rows.springs[place]
    return found


def test_numbers_of_blocks_are_numbers_texts_arrays_or_drawn():
    one = chain(mass="1 g", normal_force=[1.0, "2 kN", 3.0, 4], initial_slip=ss.Drawn("uniform", "-1 mm", 0.0, seed=3))
    assert one.values("mass").tolist() == [1e-3] * 4
    assert one.values("normal_force").tolist() == [1.0, 2000.0, 3.0, 4.0]
    assert one.values("initial_slip").tolist() == (-1e-3 + 1e-3 * np.random.default_rng(3).random(4)).tolist()


@pytest.mark.parametrize(
    ("name", "numbers", "mean", "deviation"),
    [
        ("uniform", (1.0, 3.0), 2.0, 2.0 / np.sqrt(12.0)),
        ("normal", (5.0, 0.5), 5.0, 0.5),
        ("lognormal", (1.0, 0.5), np.exp(0.125), np.exp(0.125) * np.sqrt(np.expm1(0.25))),
        ("weibull", (2.0, 2.0), np.sqrt(np.pi), np.sqrt(4.0 - np.pi)),
        ("exponential", (3.0,), 3.0, 3.0),
    ],
)
def test_drawn_numbers_have_the_mean_and_deviation_of_their_distribution(name, numbers, mean, deviation):
    drawn = ss.Drawn(name, *numbers, seed=1).values(100_000, "m")
    assert drawn.mean() == pytest.approx(mean, rel=0, abs=5.0 * deviation / 300.0)
    assert drawn.std() == pytest.approx(deviation, rel=0.02, abs=0)


def test_springs_of_a_chain_stand_between_neighbours():
    free = matrix_of(chain(coupling=[1.0, 2.0, 3.0]).couplings)
    assert free.tolist() == [[0, 1, 0, 0], [1, 0, 2, 0], [0, 2, 0, 3], [0, 0, 3, 0]]
    ring = matrix_of(chain(coupling=[1.0, 2.0, 3.0, 4.0], ends="periodic").couplings)
    assert ring.tolist() == [[0, 1, 0, 4], [1, 0, 2, 0], [0, 2, 0, 3], [4, 0, 3, 0]]
    fixed = matrix_of(chain(coupling=[5.0, 1.0, 2.0, 3.0, 6.0], ends="fixed").couplings)
    assert fixed.tolist() == [[5, 1, 0, 0], [1, 0, 2, 0], [0, 2, 0, 3], [0, 0, 3, 6]]
    assert matrix_of(chain(blocks=1, ends="fixed").couplings).tolist() == [[20.0]]


def test_springs_of_a_lattice_are_those_of_its_matrix():
    rows = sparse.diags([[2.0] * 2, [2.0] * 2], [-1, 1])
    columns = sparse.diags([[3.0], [3.0]], [-1, 1])
    wanted = sparse.kron(sparse.eye(2), rows) + sparse.kron(columns, sparse.eye(3))
    assert (matrix_of(chain(blocks=(2, 3), coupling=(2.0, 3.0)).couplings) == wanted.toarray()).all()
    assert (matrix_of(chain(blocks=6, coupling=wanted).couplings) == wanted.toarray()).all()
    walls = chain(blocks=(2, 3), coupling=(2.0, 3.0), ends="fixed").couplings.walls
    assert walls.tolist() == [5.0, 3.0, 5.0] * 2


def test_laws_that_are_equal_are_kept_once():
    laws, which = chain(friction=[LAW, ss.friction.Coulomb(0.5, 0.4), ss.friction.Coulomb(1.0, 0.8), LAW]).laws
    assert len(laws) == 2
    assert which.tolist() == [0, 1, 0, 0]


def test_a_chain_can_be_copied_and_pickled():
    one = chain(initial_slip=ss.Drawn("normal", 0.0, 1.0, seed=2))
    for other in (copy.deepcopy(one), pickle.loads(pickle.dumps(one))):
        assert (other.values("initial_slip") == one.values("initial_slip")).all()


BAD = {
    "mass must be greater than 0 kg, got -1": {"mass": -1.0},
    "mass[1] must be greater than 0 kg, got -2": {"mass": [1.0, -2.0, 1.0, 1.0]},
    "normal_force must have 4 numbers as there are blocks, got 3": {"normal_force": [1.0, 2.0, 3.0]},
    "blocks must be at most 1000000, got 1000000000": {"blocks": 10**9},
    "blocks must be at most 1000000, got 4000000": {"blocks": (2000, 2000)},
    "blocks must be a whole number above 0, got 0": {"blocks": 0},
    "coupling must be finite, got inf": {"coupling": np.inf},
    "coupling of 4 blocks with free ends must have 3 springs, got 4": {"coupling": [1.0] * 4},
    "coupling of a lattice must be a number or a pair": {"blocks": (2, 2), "coupling": [1.0] * 3},
    "the matrix must be symmetric": {"coupling": sparse.csr_matrix(np.triu(np.ones((4, 4)), 1))},
    "the diagonal of the matrix must be 0": {"coupling": sparse.eye(4)},
    "must be a matrix of 4 by 4, got 3 by 3": {"coupling": sparse.eye(3)},
    "ends 'loose' is unknown": {"ends": "loose"},
    "needs at least 3 blocks in a circle, got 2": {"blocks": 2, "ends": "periodic"},
    "direction 'forward' needs a pull_rate of 0 or more": {"direction": "forward", "pull_rate": -1.0},
    "friction must be a law of ss.friction": {"friction": 0.6},
    "has a state variable": {"friction": ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um")},
    "friction must be one law, or one for each of 4 blocks, got 2": {"friction": [LAW, LAW]},
    "stiffness must be a number in N/m": {"stiffness": "1 kg"},
    "drawn for block 3: normal (mean 0, deviation 1, seed 1)": {"mass": ss.Drawn("normal", 0.0, 1.0, seed=1)},
}


@pytest.mark.parametrize("message", BAD)
def test_bad_input_is_refused_in_one_line(message):
    with pytest.raises(ss.InputError) as caught:
        chain(**BAD[message])
    told = str(caught.value)
    assert "\n" not in told
    assert message in told
    assert told.startswith("Chain: ")


@pytest.mark.parametrize(
    ("given", "named", "message"),
    [
        (("unifrm", 0.0, 1.0), {"seed": 1}, "did you mean 'uniform'"),
        (("uniform", 0.0), {"seed": 1}, "takes low and high, got 1"),
        (("uniform", 0.0, 1.0), {"seed": -1}, "seed must be a whole number"),
    ],
)
def test_bad_draws_are_refused(given, named, message):
    with pytest.raises(ss.InputError, match=message):
        ss.Drawn(*given, **named)
