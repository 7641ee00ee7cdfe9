"""Every claim's verdict, and the numbers that it rests on."""

from __future__ import annotations

import math

import pytest

from stickslip.extensions.paper.claims import CLAIMS, STATEMENTS, ClaimVerdict, Outcome

PRINTED, READING, QUALIFIED, NOT = Outcome.PRINTED, Outcome.READING, Outcome.QUALIFIED, Outcome.NOT

OUTCOMES = {
    1: READING,
    2: READING,
    3: READING,
    4: NOT,
    5: PRINTED,
    6: PRINTED,
    7: PRINTED,
    8: PRINTED,
    9: PRINTED,
    10: PRINTED,
    11: PRINTED,
    12: PRINTED,
    13: QUALIFIED,
    14: PRINTED,
    15: READING,
    16: QUALIFIED,
    17: PRINTED,
    18: PRINTED,
    19: QUALIFIED,
    20: PRINTED,
    21: NOT,
    22: QUALIFIED,
    23: QUALIFIED,
}

# (claim, label, expected, relative tolerance): values of the design's table, or closed forms
NUMBERS = [
    (1, "slip, K = G × 10³ m", 2.721335481, 1e-9),
    (1, "stop, K = G × 10³ m", 3.029102456, 1e-9),
    (1, "slip, ω = 50 /m", 0.273505101, 1e-8),
    (1, "stop, ω = 50 /m", 0.586014899, 1e-9),
    (2, "pulses, ω = 50 /m", 3, 0),
    (2, "pulses, as printed", 1, 0),
    (2, "largest slip rate, ω = 50 /m", 10.204432, 1e-7),
    (2, "slip, ω = 50 /m", 0.376105283, 1e-8),
    (3, "arrest, ω = 50 /m", 40 / 7, 1e-14),
    (3, "arrest, as printed", 7.584372, 1e-7),
    (3, "largest slip rate after arrest, ω = 50 /m", 0.0, 0),
    (4, "pulses, D0 larger by 0 mm", 3, 0),
    (5, "largest slip rate, K = G × 10³ m", 3.511221, 1e-7),
    (6, "shocks", 2, 0),
    (6, "shock 1, rate after", 4.10204081633, 1e-11),
    (6, "shock 1, traction after", 39_800_000, 1e-12),
    (6, "shock 2, time", 40 / 7, 1e-14),
    (6, "shock 2, traction after", -399_999.969, 1e-8),
    (6, "slip", 23.4402332474, 1e-11),
    (7, "critical α, from the folds", 0.196, 1e-12),
    (8, "lower fold, load", 64471887.242, 1e-11),
    (8, "solutions between the folds", 3, 0),
    (9, "folds, α = 0.098 s/m", 0, 0),
    (12, "from arrest to the second event, perfect-delay", 468.80466, 1e-7),
    (12, "from arrest to the second event, minimal", 468.80466, 1e-7),
    (12, "from arrest to the second event, maxwell", 394.26, 2e-5),
    (12, "from arrest to the second event, maximal", 378.26, 2e-5),
    (12, "load at which stick ends, maxwell", 67215203.566, 1e-11),
    (12, "load at which stick ends, maximal", 64471887.242, 1e-11),
    (13, "critical α", 0.196, 1e-12),
    (13, "shocks of the block, whole scan", 0, 0),
    (14, "largest slip rate, block with mass × 1e-06", 4.10204081633, 1e-4),
    (14, "shocks, slab with 10000 kg/m² on its contact", 0, 0),
    (16, "slip still missing to instability, as printed", 2.744086e-3 - 1e-3, 1e-6),
    (17, "jump 1, time", 2.243, 3e-4),
    (17, "jump 1, load", 8e7, 1e-12),
    (17, "jump 2, time", 5.213, 3e-4),
    (17, "jump 2, load", 64471887.242, 1e-9),
    (21, "start of event 1, K = G × 10³ m", 0.0, 0),
    (21, "start of event 2, K = G × 10³ m", 36.689, 1e-4),
    (21, "start of event 3, K = G × 10³ m", 68.267, 1e-4),
    (21, "events in 100 years, as printed", 1, 0),
    (18, "shocks within two round trips", 2, 0),
    (18, "first shock, slip rate after", 2.60306876818e-5, 1e-9),
    (18, "second shock, slip rate before", 1.40832223e-4, 1e-8),
    (18, "slip", 5.65875644e-4, 1e-8),
    (18, "time from arrest to the next event", 93880.0, 1e-9),
    (19, "Coulomb's slip rate", 0.5e8 / 9.8e6, 1e-8),
    (19, "slip rate over Coulomb's, α = 3 αc", 2 / 3, 1e-8),
    (19, "slip rate over Coulomb's, α = 10 αc", 0.9, 1e-8),
    (20, "departure at 2h/c, fig6-slab", -2 * 9.8e6 * 4.10204081633, 1e-8),
]


def test_every_claim_has_a_measurement() -> None:
    assert list(CLAIMS) == list(STATEMENTS) == list(range(1, 24))


@pytest.mark.parametrize("number", CLAIMS)
def test_every_claim_has_its_expected_outcome(number: int, verdicts: dict[int, ClaimVerdict]) -> None:
    found = verdicts[number]
    assert found.outcome == OUTCOMES[number]
    assert found.number == number
    assert found.claim == STATEMENTS[number]
    assert found.measured
    assert all(math.isfinite(m.value) for m in found.measured)
    assert found.reading or found.outcome is NOT


@pytest.mark.parametrize(("number", "label", "expected", "rtol"), NUMBERS)
def test_every_measured_number_is_the_expected_one(
    number: int, label: str, expected: float, rtol: float, verdicts: dict[int, ClaimVerdict]
) -> None:
    assert verdicts[number].value(label) == pytest.approx(expected, rel=rtol, abs=0)


def test_pulses_change_with_excess_and_with_the_law(verdicts: dict[int, ClaimVerdict]) -> None:
    counts = [m.value for m in verdicts[4].measured if m.label.startswith("pulses,")]
    excess, law = counts[:4], [counts[4], counts[0], counts[5]]
    assert sorted(set(excess)) == excess
    assert sorted(set(law)) == law


def test_hysteresis_is_read_at_the_load(verdicts: dict[int, ClaimVerdict]) -> None:
    """Stick on the way up, the fast root of the contact equation on the way down: Z v + S (muD + (muS - muD)/(1 + v)) = load."""
    folds = 6.4471887242357346e7, 8e7
    excess = 0.5 * sum(folds) - 0.3e8  # (Z v - excess)(1 + v) + S (muS - muD) = 0
    half = 0.5 * (excess / 9.8e6 - 1.0)
    fast = half + math.sqrt(half**2 + (excess - 0.5e8) / 9.8e6)
    rates = [m.value for m in verdicts[17].measured if m.label.startswith("slip rate at 72.236 MPa")]
    assert rates == pytest.approx([0.0, fast], rel=1e-9, abs=0.0)


def test_slip_law_answers_smoothly(verdicts: dict[int, ClaimVerdict]) -> None:
    spread = [m.value for m in verdicts[10].measured if m.label.startswith("relative change")]
    assert len(spread) == 2
    assert max(spread) < 1e-2


def test_every_rule_gives_shocks(verdicts: dict[int, ClaimVerdict]) -> None:
    counts = [m.value for m in verdicts[11].measured if m.label.startswith("shocks")]
    assert len(counts) == 4
    assert min(counts) >= 3


def test_first_event_is_the_same_under_every_rule(verdicts: dict[int, ClaimVerdict]) -> None:
    slips = [m.value for m in verdicts[12].measured if m.label.startswith("slip of the first event")]
    assert slips == pytest.approx([23.4402332474] * 4, rel=1e-9, abs=0)


def test_shocks_take_over_away_from_the_critical_value(verdicts: dict[int, ClaimVerdict]) -> None:
    shares = [m.value for m in verdicts[13].measured if m.label.startswith("share")]
    assert shares == sorted(shares)
    assert 0.5 < shares[0] < 0.6
    # two jumps of v0 and v1 over twice v1, at alpha_c + 1e-6
    assert shares[0] == pytest.approx((2.60306876818e-5 + 1.40832223e-4) / (2 * 1.40832223e-4), rel=1e-7, abs=0)
    assert min(shares[2:]) > 0.99


def test_rise_time_goes_with_mass(verdicts: dict[int, ClaimVerdict]) -> None:
    rise = [m.value for m in verdicts[14].measured if m.label.startswith("rise time, block")]
    assert rise[3] / rise[2] == pytest.approx(1e-2, rel=0.02, abs=0)
    rise = [m.value for m in verdicts[14].measured if m.label.startswith("rise time, slab")]
    assert [rise[1] / rise[0], rise[2] / rise[1]] == pytest.approx([0.1, 0.1], rel=1e-3, abs=0)


def test_rest_is_the_reloading_time(verdicts: dict[int, ClaimVerdict]) -> None:
    found = verdicts[15]
    for reading in ("slip law, K = G × 10³ m", "slip law, ω = 50 /m", "rate law, K = G × 10³ m"):
        expected = found.value(f"reloading time (strength − force)/(K V), {reading}")
        assert found.value(f"rest, {reading}") == pytest.approx(expected, rel=1e-9, abs=0)
        assert expected > 1.0
    assert found.value("rest, rate law, K = G × 10³ m") == pytest.approx(2.061159848 / 0.05, rel=1e-6, abs=0)


def test_chains_are_rich_and_not_as_seismicity_is(verdicts: dict[int, ClaimVerdict]) -> None:
    """The smallest event is one block between two that rest: its slip is twice the drop of friction over its springs."""
    found = verdicts[22]
    for name, coupling in (("kc/kp = 1", 1.0), ("kc/kp = 10", 10.0), ("kc/kp = 40", 40.0)):
        smallest = 2.0 * 0.3 / (1.0 + 2.0 * coupling)
        largest = smallest * 10.0 ** found.value(f"decades of moment, {name}")
        assert 5.0 < largest < 100 * 2.0 * 0.3  # all 100 blocks as one block, which its springs to the driver hold
        assert found.value(f"share of drawn catalogues that are as far, {name}") < 0.01
        assert 0.0 <= found.value(f"events after large ones, over the mean, {name}") < 0.8  # fewer, where aftershocks would be more
    # Two starts of one chain, and so two ways of rounding, differ by up to 15 %.
    kinds = {"1": 2.2, "10": 0.8, "40": 0.68, "10, weakening with slip": 1.0, "10, weakening with slip rate": 1.15}
    for name, slope in kinds.items():
        assert found.value(f"b of (2/3) log10 M, kc/kp = {name}") == pytest.approx(slope, rel=0.15, abs=0.0)


def test_load_follows_the_formula_to_twice_the_claim(verdicts: dict[int, ClaimVerdict]) -> None:
    for part in ("to h/c", "from h/c to 2h/c"):
        assert verdicts[20].value(f"largest relative departure, {part}") < 1e-14
