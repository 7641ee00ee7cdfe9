"""Every scheme against the exact solution: order, energy, the rule that it follows; series of others; what is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.schemes.contract import Meeting, Series
from stickslip.extensions.schemes.implicit import Elements
from stickslip.extensions.schemes.measures import arrest_in, period_of, pulses_in
from stickslip.extensions.schemes.regularisations import LAB
from stickslip.extensions.schemes.run import SCHEMES, SEARCHES, GridContact, _scan, grid_of, run_scheme
from stickslip.extensions.schemes.sbp import NORMS, difference
from stickslip.extensions.schemes.schemes import schemes
from stickslip.extensions.schemes.series import read_series
from stickslip.foundation.errors import InputError

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
SMOOTH = ss.Problem(SLAB, ss.friction.SinusoidalSlip(1.0, 0.5, 2.0), pull_rate=0.3, initial_slip=np.pi / 4, initial_excess=0.0)
"""Slip that begins without a shock, under friction of slip: every rule has the same solution."""
LOOP = ss.load_scenario("fig4-loop")
STICK = [name for name in SCHEMES if name != "regularised"]


@pytest.fixture(scope="module")
def exact() -> ss.Solution:
    return ss.simulate(SMOOTH, 4.0)


def error(name: str, cells: int, exact: ss.Solution) -> float:
    series = run_scheme(exact.problem, 4.0, SCHEMES[name], cells)
    inside = series.time <= 4.0
    return float(np.abs(series.slip - exact.slip(np.minimum(series.time, 4.0)) + SMOOTH.initial_slip)[inside].max())


@pytest.mark.sampled(every=11)
@pytest.mark.parametrize("name", STICK)
def test_each_scheme_converges_at_its_declared_order(name: str, exact: ss.Solution) -> None:
    coarse, fine = (error(name, cells, exact) for cells in (80, 160))
    order = np.log2(coarse / fine)
    assert order > SCHEMES[name].order - 0.35
    assert fine < 0.06 * float(exact.slip(4.0))


@pytest.mark.sampled(every=11)
@pytest.mark.parametrize("name", STICK)
def test_each_scheme_hears_a_far_stress_that_grows(name: str) -> None:
    """Over a third of the slip is its work; every scheme is within a tenth of that of the exact slab."""
    soft = replace(SMOOTH, body=replace(SLAB, driver_impedance=4e6), pull_rate=0.0, far_stress_rate=4e7)
    grown, without = (ss.simulate(replace(soft, far_stress_rate=rate), 4.0) for rate in (4e7, 0.0))
    whole = float(grown.slip(4.0)) - soft.initial_slip
    assert float(grown.slip(4.0) - without.slip(4.0)) > whole / 3.0
    assert error(name, 160, grown) < 0.1 * whole


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("way", [1.0, -1.0])
def test_schemes_see_the_law_of_the_direction_of_slip(way: float) -> None:
    """The traction of slip is S times 0.3 forwards and 0.2 backwards, to 1e-12; the slip is within 1 % of the exact one."""
    laws = (ss.friction.Coulomb(0.3, 0.3), ss.friction.Coulomb(0.2, 0.2))
    problem = ss.Problem(SLAB, ss.friction.BothWays(*laws), pull_rate=way, initial_load=0.0)
    found, exact = run_scheme(problem, 60.0, SCHEMES["central-differences"], 80), ss.simulate(problem, 60.0)
    slides = way * found.rate > 0.0
    assert slides.any()
    assert np.allclose(found.traction[slides], way * 1e8 * (0.3 if way > 0.0 else 0.2), rtol=1e-12, atol=0.0)
    assert found.slip[-1] == pytest.approx(float(exact.slip(min(found.time[-1], 60.0))), rel=0.01, abs=0.0)


def test_regularised_friction_is_that_of_the_law_times_the_tanh_of_the_slip_rate_over_its_scale() -> None:
    problem, scheme = LOOP.problem, SCHEMES["regularised"]
    series = run_scheme(problem, 4.0, scheme, 40)
    scale = scheme.smoothing * problem.normal * problem.friction.variation / SLAB.impedance  # type: ignore[attr-defined]
    wanted = problem.normal * problem.friction.coefficient(series.slip, series.rate) * np.tanh(series.rate / scale)
    assert series.traction == pytest.approx(wanted, rel=1e-9)


def test_finer_meshes_come_closer_together_for_regularised_friction_but_not_to_friction_with_stick(exact: ss.Solution) -> None:
    assert error("regularised", 160, exact) > 5.0 * error("central-differences", 160, exact)


@pytest.mark.parametrize(("inside", "degree"), [(2, 1), (4, 2), (6, 3)])
def test_differences_sum_by_parts_and_are_exact_for_polynomials(inside: int, degree: int) -> None:
    slope, norm = difference(inside, 30)
    x = np.arange(31.0)
    for power in range(degree + 1):
        assert slope @ x**power == pytest.approx(power * x ** max(power - 1, 0), rel=1e-9, abs=1e-9)
    weights, ends = np.ones(31), np.array(NORMS[inside])
    weights[: len(ends)], weights[-len(ends) :] = ends, ends[::-1]
    assert norm.tolist() == weights.tolist()
    both = np.diag(weights) @ slope.todense()
    assert np.abs(both + both.T - np.diag(np.eye(31)[-1] - np.eye(31)[0])).max() < 1e-12


def test_characteristics_have_the_rate_of_the_exact_solution_after_a_shock() -> None:
    problem = ss.load_scenario("fig6-slab").problem
    series = run_scheme(problem, 5.0, SCHEMES["characteristics"], 40)
    assert series.rate[0] == pytest.approx(float(ss.simulate(problem, 5.0).slip_rate(0.0)), rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("search", "rule"),
    [("stick-first", "minimal"), ("continue", "perfect-delay"), ("newton", "perfect-delay"), ("fastest", "maximal")],
)
def test_the_search_of_the_contact_decides_which_rule_characteristics_follow(search: str, rule: str) -> None:
    study = schemes(LOOP, None, "characteristics", [100], search=search)
    assert study.verdicts == {"characteristics": rule}


@pytest.mark.parametrize("search", SEARCHES)
def test_each_search_finds_the_root_that_it_names(search: str) -> None:
    problem = LOOP.problem
    excess = 70e6 - problem.strength
    rates = ss.uniqueness(problem).admissible(70e6)
    contact = GridContact(problem, search)
    found = {before: contact.meet(Meeting(70e6, SLAB.impedance, 0.0), before).rate for before in (0.0, 0.9 * max(rates))}
    assert excess < 0.0
    top = pytest.approx(max(rates), rel=1e-12, abs=0.0)
    wanted = {
        "stick-first": {0.0: 0.0, 0.9 * max(rates): 0.0},
        "continue": {0.0: 0.0, 0.9 * max(rates): top},
        "newton": {0.0: 0.0, 0.9 * max(rates): top},
        "fastest": {0.0: top, 0.9 * max(rates): top},
    }[search]
    assert found == wanted


def test_from_slip_that_is_too_fast_the_search_goes_down_to_the_next_root() -> None:
    """What is missing changes its sign at every multiple of pi, and rises at the even ones."""
    assert _scan(np.sin, 4.5 * np.pi, 6.9 * np.pi, "continue") == pytest.approx(4.0 * np.pi, rel=1e-12, abs=0.0)
    assert _scan(np.sin, 3.5 * np.pi, 6.9 * np.pi, "continue") == pytest.approx(4.0 * np.pi, rel=1e-12, abs=0.0)


def test_a_contact_that_is_pushed_backwards_slips_backwards() -> None:
    contact = GridContact(LOOP.problem)
    forward, backward = (contact.meet(Meeting(load, SLAB.impedance, 0.0), 0.0) for load in (90e6, -90e6))
    assert forward.rate == -backward.rate > 0.0
    assert forward.traction == -backward.traction > 0.0


def test_periods_of_friction_say_how_far_slip_went_where_ringing_makes_pulses() -> None:
    """The slip law of Fig. 5 repeats itself every 2 pi/50 m: the exact contact slips through three periods."""
    study = schemes("fig5-slab-reconstructed", cells=20)
    law = study.problem.friction
    row = study.table.iloc[0]
    assert period_of(law) == pytest.approx(2.0 * np.pi / law.wavenumber, rel=1e-15, abs=0.0)
    assert row.periods == pytest.approx(float(study.series[0].slip.max()) * law.wavenumber / (2.0 * np.pi), rel=1e-12, abs=0.0)
    assert row.periods > 100.0
    assert float(study.own.slip(study.until)) / period_of(law) < 4.0
    assert np.isnan(period_of(ss.friction.HyperbolicRate(0.8, 0.3, 1.0)))
    assert period_of(ss.friction.SlipTimesRate(law, ss.friction.HyperbolicRate(1.0, 0.5, 1.0))) == period_of(law)


def test_pulses_and_arrest_are_counted_as_in_the_events() -> None:
    rate = np.array([0.0, 1.0, 0.6, 1.0, 0.4, 1.0, 0.1, 0.15, 0.0, 0.0])
    assert pulses_in(rate, 1e-6) == 2
    assert pulses_in(np.array([0.0, 1.0, 0.1, 0.3, 0.0]), 1e-6) == 2
    assert pulses_in(np.zeros(5), 1e-6) == 0
    assert arrest_in(np.arange(10.0), rate, 1e-6) == 8.0
    assert np.isnan(arrest_in(np.arange(3.0), np.array([0.0, 1.0, 1.0]), 1e-6))


def test_files_keep_every_number(tmp_path: Path) -> None:
    study = schemes(SMOOTH, 1.0, "theta", [20, 40])
    import pandas as pd

    table = pd.read_csv(study.to_csv(tmp_path / "a.csv"), comment="#")
    assert table.slip_error.tolist() == study.table.slip_error.tolist()


def test_interrupted_studies_keep_the_rows_that_were_finished() -> None:
    told: list[str] = []

    def stop(text: str) -> None:
        told.append(text)
        if text == "theta, 40 cells":
            raise KeyboardInterrupt

    study = schemes(SMOOTH, 1.0, "theta", [20, 40], progress=stop)
    assert study.interrupted
    assert study.table.cells.tolist() == [20]
    assert "theta, 20 cells" in told


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: schemes("fig6-block-printed"), "schemes: SpringBlock has no grid"),
        (lambda: schemes("cycles-slab"), "schemes: a contact_mass of"),
        (lambda: schemes("rate-and-state-slab", 1.0), "schemes: rate-and-state"),
        (lambda: schemes("fig6-slab", scheme="newmrk"), "schemes: there is no scheme 'newmrk'; did you mean 'newmark'?"),
        (lambda: schemes("fig6-slab", search="x"), "schemes: there is no search 'x'"),
        (lambda: schemes("fig6-slab", cells=[3]), "schemes: cells must be a whole number from 12 to 100000, got 3"),
        (lambda: schemes("fig6-slab", courant=2.0), "schemes: central-differences: the Courant number must lie in"),
        (lambda: schemes("fig6-slab", 1e6, cells=[1000]), "schemes: .* steps of"),
        (lambda: schemes("fig6-slab", scheme=object()), "schemes: a scheme needs name, title"),
        (lambda: schemes("fig6-slab", scheme=["theta", "sbp2", "theta"]), "^schemes: the scheme 'theta' is given twice$"),
        (lambda: schemes("fig6-slab", scheme=["lag", LAB["lag"]]), "^schemes: the scheme 'lag' is given twice$"),
        (lambda: read_series("no-such-file.csv"), "no-such-file.csv: no such file"),
        (lambda: Series(np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)), "series: times must ascend, but 0 s"),
    ],
)
def test_mistakes_are_refused_in_one_line(call, message: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError, match=message) as error:
        call()
    assert "\n" not in str(error.value)


def test_backward_euler_stops_where_its_effective_impedance_says() -> None:
    """Closed form: rest begins at beta + (kappa - 1) Z v = S mu_static, kappa = sqrt(1 + 1/(12 nu^2)), on any mesh."""
    run, courant = ss.simulate(LOOP), 0.4
    time = np.linspace(2.5, 5.2, 20_001)
    kappa = np.sqrt(1.0 + 1.0 / (12.0 * courant**2))
    expected = time[run.load(time) + (kappa - 1.0) * SLAB.impedance * run.slip_rate(time) < 80e6][0]
    for cells in (50, 200):
        study = schemes(LOOP, None, "backward-euler", [cells], courant=courant)
        assert 0.0 <= study.table.arrest.iloc[0] - expected < 2.0 * study.table.step.iloc[0]


@pytest.mark.parametrize(("name", "courant"), [("newmark", 0.5), ("newmark", 2.0), ("theta", 0.3), ("backward-euler", 1.0)])
def test_finite_elements_have_the_effective_impedance_of_the_closed_form(name: str, courant: float) -> None:
    """A chain without end: 1/(12 theta^2 nu^2) + 1, where Newmark's method is theta = 1/2."""
    theta = {"newmark": 0.5, "theta": 0.6, "backward-euler": 1.0}[name]
    motion = SCHEMES[name].begin(grid_of(SMOOTH, 4.0, 200, courant))
    assert isinstance(motion, Elements)
    kappa = 1.0 / float(motion.reply[0]) / SLAB.impedance
    assert kappa == pytest.approx(np.sqrt(1.0 + 1.0 / (12.0 * theta**2 * courant**2)), rel=1e-9, abs=0.0)
