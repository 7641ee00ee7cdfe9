"""The bundled scenarios: their numbers against their definitions, and every one readable, explained and round-tripping."""

import math

import pytest
from mpmath import acos, cos, mp, mpf, pi, sin

from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.scenario import load_scenario, read_scenario

mp.dps = 40
ULP = 2.3e-16
YEAR = 31_557_600.0


SHAKEN = ("sliding-block-shaken", "sliding-slab-shaken")
PAPERS = [name for name in library.names() if name.startswith(("fig", "second-event"))]


def test_every_scenario_has_its_trade_and_only_those_of_the_paper_are_of_the_paper() -> None:
    found = library.by_trade()
    assert sorted(name for names in found.values() for name in names) == library.names()
    assert list(found) == sorted(found)
    assert found["Drilling"] == ["drill-string", "pipe-and-collar"]
    assert set(found["Slopes in earthquakes"]) == set(SHAKEN)
    assert set(found["The source paper"]) == {"block-or-slab", *PAPERS}


@pytest.mark.sampled(every=10)
@pytest.mark.parametrize("name", library.names())
def test_every_scenario_explains_itself_and_round_trips(name: str) -> None:
    scenario = load_scenario(name)
    assert scenario.name == name
    assert scenario.title
    assert scenario.description
    header = scenario.source.partition("\ntitle")[0]
    assert "# Source: " in header
    if name in PAPERS:
        assert "# Source: Campillo" in header
        assert "Reading:" in header or name == "fig4-loop"
    again = read_scenario(scenario.to_toml(), "again")
    assert again == scenario
    assert again.to_toml() == scenario.to_toml()
    assert repr(again.problem) == repr(scenario.problem)


@pytest.mark.parametrize("name", PAPERS)
def test_the_constants_are_those_of_the_paper(name: str) -> None:
    problem = load_scenario(name).problem
    body = problem.body
    if "block" in name:
        assert (body.mass, body.normal_force) == (2.8e12, 1e14)
        assert body.stiffness == (3.43e13 if name.endswith(("fig6-block-reconstructed", "-k", "critical")) else 3.43e14)
    else:
        assert (body.density, body.wave_speed, body.thickness, body.normal_stress) == (2800, 3500, 1e4, 1e8)
        assert math.isinf(body.driver_impedance) or name == "fig4-loop"
    assert problem.pull_rate == (2.6 if name == "fig4-loop" else 0.05 / YEAR)


@pytest.mark.parametrize(
    ("name", "omega", "beyond", "added_to_driver"),
    [
        ("fig5-slab-printed", 5, "1e-3", "0"),
        ("fig5-slab-reconstructed", 50, "1e-3", "1e-3"),
        ("fig5-slab-u0-1e-2", 5, "1e-2", "0"),
    ],
)
def test_the_slab_starts_beyond_the_slip_of_largest_friction(name: str, omega: int, beyond: str, added_to_driver: str) -> None:
    """u0 = u_c + beyond, S mu'(u_c) = 0, load = S mu(u_c) + G/h times what is added to D0."""
    problem = load_scenario(name).problem
    critical = pi / (2 * omega)
    slip = critical + mpf(beyond)
    added = mpf("3.43e6") * mpf(added_to_driver)
    excess = mpf(10) ** 8 / 2 * (1 - cos(omega * mpf(beyond))) + added
    assert problem.friction.wavenumber == omega
    assert problem.initial_slip == pytest.approx(float(slip), rel=ULP, abs=0)
    assert problem.excess == pytest.approx(float(excess), rel=ULP, abs=0)
    assert problem.load == pytest.approx(150e6 + float(added), rel=ULP, abs=0)


@pytest.mark.parametrize(
    ("name", "stiffness", "omega"),
    [("fig5-block-reconstructed-k", "3.43e13", 5), ("fig5-block-reconstructed-omega", "3.43e14", 50)],
)
def test_the_block_starts_where_the_spring_balances_weakening(name: str, stiffness: str, omega: int) -> None:
    """S mu'(u0) + K = 0, load = S mu(u0) + K 1e-3 m."""
    problem = load_scenario(name).problem
    slip = acos(-mpf(stiffness) / (mpf(10) ** 14 / 2 * omega)) / omega
    assert problem.initial_slip == pytest.approx(float(slip), rel=ULP, abs=0)
    assert problem.excess == pytest.approx(float(mpf(stiffness) / 1000), rel=ULP, abs=0)
    load = mpf(10) ** 14 * (1 + sin(omega * slip) / 2) + mpf(stiffness) / 1000
    assert problem.load == pytest.approx(float(load), rel=2 * ULP, abs=0)


def test_the_printed_block_has_no_start_of_the_paper() -> None:
    problem = load_scenario("fig5-block-printed").problem
    steepest = problem.normal * problem.friction.amplitude * problem.friction.wavenumber
    assert steepest < problem.body.stiffness
    assert problem.initial_slip == pytest.approx(math.pi / 5, rel=ULP, abs=0)


@pytest.mark.parametrize(
    ("name", "rate"),
    [("fig5-slab-printed", 6.377538e-5), ("fig6-slab", 0.0), ("fig5-slab-reconstructed", 65916.98025168767 / 9.8e6)],
)
def test_the_first_slip_rate_of_a_slip_law_follows_from_the_excess(name: str, rate: float) -> None:
    problem = load_scenario(name).problem
    assert problem.excess / problem.body.impedance == pytest.approx(rate, rel=2e-7, abs=0)


def test_the_rules_differ_in_nothing_else() -> None:
    texts = {load_scenario(f"second-event-{rule}").problem.selection for rule in ("perfect-delay", "maxwell", "minimal", "maximal")}
    assert texts == {"perfect-delay", "maxwell", "minimal", "maximal"}
    assert load_scenario("second-event-maxwell").duration == 480 * YEAR
    assert load_scenario("second-event-perfect-delay").problem == load_scenario("fig6-slab").problem
