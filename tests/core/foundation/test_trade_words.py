"""What people of the trades type in place of our names is answered with those: one table of words, wherever a name stands."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

import stickslip as ss
from stickslip.cli.app import COMMANDS
from stickslip.cli.main import main
from stickslip.foundation.errors import MOST_NAMED, InputError, meant, nearest
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.parameter_paths import find_parameter, parameter_paths
from stickslip.problem.scenarios.scenario import read_scenario
from stickslip.problem.scenarios.templates import template

scenario = cache(ss.load_scenario)


@cache
def run() -> Any:
    return ss.simulate("fig6-slab")


NUMBERS = [
    ("rate-and-state-block", "Dc", "distance"),
    ("rate-and-state-block", "d_c", "distance"),
    ("rate-and-state-block", "friction.L", "friction.distance"),
    ("rate-and-state-block", "k", "stiffness"),
    ("rate-and-state-block", "K", "stiffness"),
    ("rate-and-state-block", "body.spring_constant", "body.stiffness"),
    ("rate-and-state-block", "mu0", "reference"),
    ("rate-and-state-block", "f_0", "reference"),
    ("rate-and-state-block", "sigma_n", "normal_force"),
    ("rate-and-state-block", "V", "pull_rate"),
    ("rate-and-state-block", "v_pl", "pull_rate"),
    ("rate-and-state-block", "plate velocity", "pull_rate"),
    ("rate-and-state-block", "theta", "state"),
    ("rate-and-state-block", "eta", "damping"),
    ("rate-and-state-block", "tmax", "duration"),
    ("fig6-slab", "mu0", "static"),
    ("fig6-slab", "mu_s", "static"),
    ("fig6-slab", "μ_d", "dynamic"),
    ("fig6-slab", "mu", "static' or 'dynamic"),
    ("fig6-slab", "σn", "normal_stress"),
    ("fig6-slab", "Sigma-N", "normal_stress"),
    ("fig6-slab", "rho", "density"),
    ("fig6-slab", "vs30", "wave_speed"),
    ("fig6-slab", "h", "thickness"),
    ("fig6-slab", "velocity", "pull_rate"),
    ("fig6-slab", "rule", "selection"),
    ("fig6-slab", "t_end", "duration"),
    ("fig6-slab", "tol", "rtol"),
    ("drill-string", "wob", "weight_on_bit"),
    ("drill-string", "rpm", "pull_rate"),
    ("drill-string", "body.od", "body.outer_diameter"),
    ("drill-string", "G", "shear_modulus"),
    ("drill-string", "L", "length"),
    ("drill-string", "J", "inertia' or 'polar_moment"),
    ("sliding-block-shaken", "ky", "static"),
    ("sliding-block-shaken", "yield", "static"),
    ("sliding-block-shaken", "displacement", "slip"),
    ("reversing-axis", "sigma0", "body.stiffness' or 'friction.stiffness"),
    ("reversing-axis", "feed", "pull_rate"),
    ("reversing-axis", "kinetic", "dynamic"),
]


@pytest.mark.parametrize(("name", "typed", "wanted"), NUMBERS)
def test_a_number_by_the_name_of_a_trade_is_answered_with_ours(name: str, typed: str, wanted: str) -> None:
    with pytest.raises(InputError, match=re.escape(f"did you mean '{wanted}'?")):
        find_parameter(scenario(name), typed, "run: --set")


def test_a_word_whose_meaning_is_not_here_is_not_taken_for_one_that_is_spelled_alike() -> None:
    with pytest.raises(InputError, match="it may stand for stiffness or wavenumber, which are not here; allowed: "):
        find_parameter(scenario("fig6-slab"), "k", "run: --set")
    with pytest.raises(InputError, match="it may stand for ground_acceleration or amplitude, which are not here; "):
        find_parameter(scenario("sliding-block-shaken"), "pga", "run: --set")
    with pytest.raises(InputError) as told:
        find_parameter(scenario("sliding-block-shaken"), "acceleration", "run: --set")  # spelled like selection
    assert "did you mean" not in str(told.value)


WORDS = [
    (["plot"], "did you mean 'run' or 'show'?"),
    (["list"], "did you mean 'new'?"),
    (["help"], "did you mean `stickslip --help`?"),
    (["version"], "did you mean `stickslip --version`?"),
    (["RUN", "fig6-slab"], "did you mean 'run'?"),
    (["find", "fig6-slab", "--what", "stuck"], "did you mean 'sticking'?"),
    (["simulate"], "did you mean 'run'?"),
    (["run.nc"], "did you mean `stickslip show run.nc`?"),
    (["run", "fig6-slab", "--rule", "maxwell"], "did you mean '--selection'?"),
    (["run", "fig6-slab", "--output", "a.nc"], "did you mean '--out'?"),
    (["run", "fig6-slab", "--plot", "a.png"], "did you mean '--figure'?"),
    (["run", "fig6-slab", "--tmax", "3"], "did you mean '--duration'?"),
    (["run", "fig6-slab", "--tol", "3"], "did you mean '--rtol'?"),
    (["run", "fig6-slab", "--params", "a=3"], "did you mean '--set'?"),
    (["run", "fig6-slab", "--max_events", "3"], "did you mean '--events'?"),
    (["new", "slab", "--law", "coulomb"], "did you mean '--friction'?"),
    (["new", "slab", "--loading", "steps"], "did you mean '--pull'?"),
    (["run", "newmark"], "did you mean 'sliding-block-shaken'?"),
    (["run", "block.toml"], "`stickslip new block > block.toml` writes one to start from"),
    (["new", "axis"], "did you mean 'reversing-axis'"),
    (["new", "slab", "--friction", "rsf"], "did you mean 'rate-and-state'?"),
    (["new", "slab", "--friction", "stribeck"], "did you mean 'exponential-stribeck' or 'power-stribeck'?"),
    (["new", "slab", "--pull", "sine"], "did you mean 'sinusoidal'?"),
]


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(("typed", "wanted"), WORDS, ids=[" ".join(typed) for typed, _ in WORDS])
def test_a_command_in_the_words_of_a_trade_is_answered_with_ours(
    typed: list[str], wanted: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(typed)
    said = capsys.readouterr().err
    assert ended.value.code == 2
    assert wanted in said
    assert said.count("\n") == 1


KEYS = [
    ("slab", "thickness", "h", "thickness"),
    ("slab", "wave_speed", "Vs", "wave_speed"),
    ("slab", "static", "mu_s", "static"),
    ("slab", "pull_rate", "v_plate", "pull_rate"),
    ("block", "stiffness", "k", "stiffness"),
    ("string", "weight_on_bit", "WOB", "weight_on_bit"),
]


TABLES_OF_TRADES = [("[run]", "[simulation]", "run"), ("[loading]", "[drive]", "loading"), ("[initial]", "[start]", "initial")]
KINDS = [('"spring-block"', "spring-slider", "spring-block"), ('"hyperbolic-rate"', "dieterich", "rate-and-state")]


@pytest.mark.parametrize(
    ("ours", "typed", "wanted"), [*TABLES_OF_TRADES, *((old, f'"{new}"', wanted) for old, new, wanted in KINDS)]
)
def test_a_table_and_a_kind_by_the_name_of_a_trade_are_answered_with_ours(ours: str, typed: str, wanted: str) -> None:
    text = re.sub(rf"^((kind = )?){re.escape(ours)}", rf"\g<1>{typed}", template("block"), flags=re.MULTILINE)
    assert typed in text
    with pytest.raises(InputError, match=f"is unknown; did you mean '{wanted}'"):
        read_scenario(text, "mine.toml")


def test_a_key_of_another_body_is_told_with_that_of_this_one() -> None:
    text = template("block").replace("normal_force =", "normal_stress =")
    with pytest.raises(InputError, match=r"it is a key of elastic-slab, .*, and not of this kind; did you mean 'normal_force'\?"):
        read_scenario(text, "mine.toml")


@pytest.mark.parametrize(("starter", "ours", "typed", "wanted"), KEYS)
def test_a_key_of_a_file_by_the_name_of_a_trade_is_answered_with_ours(starter: str, ours: str, typed: str, wanted: str) -> None:
    text, found = re.subn(rf"^{ours} =", f"{typed} =", template(starter), flags=re.MULTILINE)
    assert found == 1
    with pytest.raises(InputError, match=f"{typed} is unknown; .*{wanted}"):
        read_scenario(text, "mine.toml")


CALLS: list[tuple[Callable[[], Any], str]] = [
    (lambda: run().displacement, "did you mean 'slip'?"),
    (lambda: run().velocity, "did you mean 'slip_rate'?"),
    (lambda: run().tau, "did you mean 'load' or 'traction'?"),
    (lambda: run().save, "did you mean 'to_netcdf'"),
    (lambda: run().show, "did you mean 'plot'"),
    (lambda: run().curve("displacement"), "did you mean 'slip'?"),
    (lambda: run().problem.sigma, "it has "),
    (lambda: ss.SpringBlock(m=1.0, stiffness=1.0, normal_force=1.0), "did you mean 'mass'?"),  # type: ignore[call-arg]
    (lambda: ss.SpringBlock(mass=1.0, k=1.0, normal_force=1.0), "did you mean 'stiffness'?"),  # type: ignore[call-arg]
    (lambda: ss.friction.Coulomb(mu_s=0.6, mu_d=0.5), "did you mean 'static'?"),  # type: ignore[call-arg]
    (lambda: ss.friction.RateAndState(f0=0.6, a=0.01, b=0.02, distance=1.0), "did you mean 'reference'?"),  # type: ignore[call-arg]
    (lambda: ss.friction.RateAndState(0.6, 0.01, 0.02, Dc=1.0), "did you mean 'distance'?"),  # type: ignore[call-arg]
    (lambda: ss.simulate("fig6-slab", t_end=3.0), "did you mean 'duration'?"),  # type: ignore[call-overload]
    (lambda: ss.simulate("fig6-slab", rule="maxwell"), "did you mean 'selection'?"),  # type: ignore[call-overload]
    (lambda: ss.simulat, "did you mean 'simulate'?"),  # type: ignore[attr-defined]
    (lambda: ss.Block, "did you mean 'RotatingBlock' or 'SpringBlock'?"),  # type: ignore[attr-defined]
    (lambda: ss.DrillString, "did you mean 'TorsionalString' or 'SectionedString'?"),  # type: ignore[attr-defined]
    (lambda: ss.integrate, "did you mean 'simulate'?"),  # type: ignore[attr-defined]
    (lambda: ss.friction.RateStateFriction, "did you mean 'RateAndState'?"),  # type: ignore[attr-defined]
    (lambda: ss.friction.Stribeck, "did you mean 'ExponentialStribeck' or 'PowerStribeck'?"),  # type: ignore[attr-defined]
    (lambda: ss.studies.threshold, "did you mean 'find'?"),  # type: ignore[attr-defined]
    (lambda: ss.loading.Sine, "did you mean 'Sinusoidal'"),
]


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(("call", "wanted"), CALLS, ids=[wanted for _, wanted in CALLS])
def test_python_in_the_words_of_a_trade_is_answered_with_ours(call: Callable[[], Any], wanted: str) -> None:
    with pytest.raises((AttributeError, InputError), match=re.escape(wanted)):
        call()


@pytest.mark.parametrize(
    ("typed", "allowed", "wanted"),
    [
        ("displacment", ("slip", "slip_rate", "load"), ["slip"]),
        ("torqe", ("slip", "load", "pull_rate"), ["load"]),
        ("simulat", ("new", "run", "show"), ["run"]),
        ("friction.displacment", ("friction.slip", "body.mass"), ["friction.slip"]),
        ("block-on-spring", ("elastic-slab", "spring-block", "rotating-block"), ["spring-block"]),
        ("qwertz", ("slip", "load"), []),
        ("torqe", ("mass", "damping"), []),
    ],
)
def test_a_misspelt_word_and_words_in_another_order_are_answered_as_those_meant(
    typed: str, allowed: tuple[str, ...], wanted: list[str]
) -> None:
    assert meant(typed, allowed) == wanted


def test_no_answer_names_many() -> None:
    for many in (list(library.names()), [*COMMANDS, *library.STARTERS], list(ss.friction.LAWS), dir(run())):
        said = nearest("qqqq", many, listed="there")
        assert said.count(",") < MOST_NAMED
        assert said.endswith(f" and {len(many) - said.count(',') - 1} more: there")
    with pytest.raises(InputError) as told:
        find_parameter(scenario("drill-string"), "qqqq", "run: --set")
    assert str(told.value).count(",") < MOST_NAMED
    assert str(told.value).endswith("more: `stickslip check SCENARIO --parameters` lists all")


def test_of_a_word_of_a_million_letters_only_the_beginning_is_compared() -> None:
    """Keys of a stranger's file may be long, and comparing them whole would take long."""
    assert meant("ab" * 500_000, ["ab" * 40, "other"]) == ["ab" * 40]


def test_the_list_that_answers_point_at_has_every_name(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["check", "drill-string", "--parameters"])
    shown = {line.split()[0] for line in capsys.readouterr().out.splitlines() if line.split()}
    assert {one.name for one in parameter_paths(scenario("drill-string"))} <= shown
