"""What newcomers write in Python by mistake: each call is refused in one line that names the cure, or gives what they mean."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip

ss: Any = stickslip
"""The package as newcomers have it: no type checker reads what they write."""
STATED: dict[str, Any] = {"density": 2800, "wave_speed": 3500, "thickness": 1e4, "normal_stress": 1e8}
SLAB = ss.ElasticSlab(**STATED)
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
PROBLEM = ss.Problem(SLAB, LAW, pull_rate=1.0, initial_excess=0.0)
STATE: dict[str, Any] = {"a": 0.01, "b": 0.015, "distance": 1e-5, "reference": 0.6, "rate": 1e-6}
MOST_NAMES = 8
"""A message lists at most this many names."""
LIST = re.compile(rf"(?:[\w.'<>-]+, ){{{MOST_NAMES},}}[\w.'<>-]+")


@cache
def run() -> Any:
    """Return a run of 5 s."""
    return ss.simulate(PROBLEM, 5.0)


def slab(**given: Any) -> Any:
    return ss.ElasticSlab(**STATED | given)


def law(**given: Any) -> Any:
    return ss.friction.HyperbolicRate(**{"static": 0.8, "dynamic": 0.3, "alpha": 1.0} | given)


def problem(**given: Any) -> Any:
    return ss.Problem(SLAB, LAW, **{"pull_rate": 1.0, "initial_excess": 0.0} | given)


REFUSED: list[tuple[Callable[[], Any], str]] = [
    # values
    (lambda: slab(thickness="10 kg"), "thickness must be a number in m ... 'kg' does not convert to m"),
    (lambda: slab(density="2800"), "density must be a number in kg/m^3 ... got '2800': write a number without quotes"),
    (lambda: slab(density=-1), "density must be greater than 0 kg/m^3, got -1"),
    (lambda: slab(density=float("nan")), "density must be finite, got nan"),
    (lambda: slab(density=None), "density must be a number in kg/m^3 ... got None"),
    (lambda: slab(density=[2800]), "density must be a number in kg/m^3 ... got [2800]"),
    (lambda: slab(density=np.array([2800.0])), "density must be a number in kg/m^3 ... got ndarray"),
    (lambda: slab(density=True), "density must be a number in kg/m^3 ... got True"),
    (lambda: slab(density=(2800, "kg/m^3")), "density must be a number in kg/m^3 ... got (2800, 'kg/m^3')"),
    (lambda: slab(thickness="10,5 km"), "write '10.5 km', with a decimal point"),
    (lambda: slab(thickness="10 Km"), "did you mean 'km'?"),
    (lambda: slab(thickness="5 ft 6 in"), "write '5.5 ft', in one unit"),
    (lambda: ss.ElasticSlab(), "density, wave_speed, thickness, normal_stress must be given"),
    (lambda: ss.SpringBlock(mass=20, stiffness=1e8, normal_force="5 MPa"), "'MPa' does not convert to N"),
    (lambda: ss.SpringBlock(mass=20, stiffness=1e8, normal_force="5 t"), "it is a mass; a weight is in tf"),
    (lambda: law(static="0,8"), "static must be a number, got '0,8': write '0.8'"),
    (lambda: law(static="80%"), "static must be a number, got '80%'; write 0.8"),
    (lambda: law(alpha="1 m/s"), "'m/s' does not convert to s/m"),
    (lambda: ss.friction.Coulomb(0.6), "Coulomb: dynamic must be given"),
    (lambda: ss.friction.RateAndState(**STATE, evolution="aging"), "did you mean 'ageing'?"),
    (lambda: ss.friction.RateAndState(**STATE, evolution="dieterich"), "allowed: ageing, prz, slip"),
    (lambda: ss.loading.Steps([0, 1], [1, 2, 3]), "Steps: 2 times but 3 values"),
    (lambda: ss.loading.Steps([1, 0], [1, 2]), "times must ascend, but [1] = 0 follows 1; sort the points"),
    (lambda: ss.loading.Waypoints([0, 1], [0, "1 s"]), "positions[1] must be ... 's' does not convert to m or rad"),
    (lambda: ss.loading.Steps(["0 s", "1 h"], ["1 um/s", "10 MPa"]), "values[1] must be ... 'MPa' does not convert to m/s"),
    # problems
    (lambda: ss.Problem(LAW, SLAB), "body comes first, then friction"),
    (lambda: ss.Problem(SLAB, "coulomb"), "the laws of the package are classes, such as ss.friction.Coulomb(...)"),
    (lambda: ss.Problem(SLAB, 0.6), 'friction must be a friction law ... or a text such as "0.3 + 0.5/(1 + v)", got 0.6'),
    (lambda: ss.Problem(SLAB, "0.6 * x", initial_load=1.0), "'x' is neither u, v, pi nor a declared parameter"),
    (lambda: ss.Problem(SLAB, LAW), "needs either initial_load or initial_excess (load minus static strength), got neither"),
    (lambda: problem(initial_load=8e7), "needs either initial_load or initial_excess ... got both"),
    (lambda: problem(pull_rate="5 cm"), "'cm' does not convert to m/s"),
    (lambda: problem(pull_rate="60 rpm"), "'rpm' does not convert to m/s"),
    (lambda: problem(pull_rate=[1, 2, 3]), "what varies in time is one of stickslip.loading"),
    (lambda: problem(selection="maxwel"), "did you mean 'maxwell'?"),
    # runs
    (lambda: ss.simulate(PROBLEM), "duration must be a number in s ... got None"),
    (lambda: ss.simulate(PROBLEM, "ten seconds"), "got 'ten seconds'"),
    (lambda: ss.simulate(PROBLEM, "10 yeers"), "'yeers' is not a unit; did you mean 'year'?"),
    (lambda: ss.simulate(PROBLEM, "1 h 30 min"), "write '1.5 h', in one unit"),
    (lambda: ss.simulate(PROBLEM, -1), "duration must be greater than 0 s, got -1"),
    (lambda: ss.simulate(PROBLEM, (0, 10)), "got (0, 10)"),
    (lambda: ss.simulate(PROBLEM, 10, rtol="tight"), "rtol must be a number, got 'tight'"),
    (lambda: ss.simulate(SLAB, 10), "problem must be a Problem, a scenario, or the name of one, got ElasticSlab"),
    (lambda: ss.simulate("fig6_slab"), "did you mean 'fig6-slab'?"),
    (lambda: ss.simulate("missing.toml"), "missing.toml: no such file"),
    (lambda: ss.load_scenario("slab.toml"), "`stickslip new slab > slab.toml` writes one to start from"),
    (lambda: ss.open_solution("missing.nc"), "missing.nc: no such file"),
    # results
    (lambda: run().slip(100), "times must lie between 0 and the end of the run, 5 s"),
    (lambda: run().slip_rate(1, side="before"), "side must be 'left' or 'right', got 'before'"),
    (lambda: run().to_netcdf("a.csv"), "a.csv: what is written is netCDF: the name must end in .nc"),
    (lambda: ss.uniqueness(PROBLEM).critical, "has no attribute 'critical'; did you mean 'critical"),
    # studies
    (lambda: ss.sweep("fig6-slab", {"alpha": "0.1..1:3"}), "use a list or numpy.linspace"),
    (lambda: ss.studies.find("fig6-slab", "alpha"), "give two values of friction.alpha"),
    (lambda: ss.studies.compare("fig6-slab"), "needs two scenarios or runs, or more, got 1"),
    (lambda: ss.studies.severity(PROBLEM), "severity: needs a Solution, got Problem"),
    (lambda: ss.studies.infer("velocity-steps-block", {}, []), "time"),
    (lambda: ss.friction.Points.read("v (mm/s),mu\n"), "no such file"),
    # synonyms
    (lambda: ss.ElasticSlab(rho=2800, c=3500, h=1e4, sigma=1e8), "unknown argument 'rho'; did you mean ... density"),
    (lambda: ss.SpringBlock(m=20, k=1e8, N=5e4), "unknown argument 'm'; did you mean ... mass"),
    (lambda: law(mu_s=0.8), "unknown argument 'mu_s'; did you mean ... static"),
    (lambda: ss.friction.RateAndState(a=0.01, b=0.015, Dc=1e-5), "unknown argument 'Dc'; did you mean ... distance"),
    (lambda: problem(V="5 cm/yr"), "unknown argument 'V'; did you mean ... pull_rate"),
    (lambda: problem(rule="maxwell"), "unknown argument 'rule'; did you mean ... selection"),
    (lambda: ss.simulate(PROBLEM, time=10), "unknown argument 'time'; did you mean ... duration"),
    (lambda: ss.simulate(PROBLEM, 10, dt=0.01), "unknown argument 'dt'"),
    (lambda: ss.simulate("fig6-slab", alpha=2), "unknown argument 'alpha'"),
    (lambda: run().displacement, "has no attribute 'displacement'; did you mean ... slip"),
    (lambda: run().velocity(1), "has no attribute 'velocity'; did you mean ... slip_rate"),
    (lambda: run().stress(1), "has no attribute 'stress'; did you mean ... traction"),
    (lambda: run().v, "did you mean ... slip_rate"),
    (lambda: run().t, "has no attribute 't'"),
    (lambda: run().save("a.nc"), "did you mean ... to_netcdf"),
    (lambda: PROBLEM.replace(pull_rate=2), "dataclasses.replace"),
    (lambda: ss.sweep("fig6-slab", {"alpha": [1, 2]}, quantities=["displacement"]), "did you mean ... slip"),
    (lambda: ss.sweep("fig6-slab", alpha=[1, 2]), "unknown argument 'alpha'"),
    (lambda: ss.Slab(**STATED), "did you mean ... ElasticSlab"),
    (lambda: ss.Block(1, 1, 1), "did you mean ... SpringBlock"),
    (lambda: ss.friction.RateState, "did you mean ... RateAndState"),
    (lambda: ss.friction.Stribeck, "did you mean ... ExponentialStribeck"),
    (lambda: ss.infer, "it is stickslip.studies.infer"),
    (lambda: ss.HyperbolicRate, "it is stickslip.friction.HyperbolicRate"),
]
"""Calls, and what the one line of their error has; where a wanted text has " ... ", its parts stand in this order."""


def refusal(call: Callable[[], Any]) -> str:
    """Return the message with which a call is refused."""
    with pytest.raises((ss.InputError, AttributeError, TypeError)) as told:
        call()
    return str(told.value)


def stand_in_order(wanted: str, text: str) -> bool:
    """Return True if the parts of a wanted text, between its " ... ", stand in a text in this order."""
    return re.search(".*".join(map(re.escape, wanted.split(" ... "))), text) is not None


@pytest.mark.parametrize(("call", "wanted"), REFUSED, ids=[wanted[:50] for _, wanted in REFUSED])
def test_a_clumsy_call_is_refused_with_the_cure(
    call: Callable[[], Any], wanted: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    message = refusal(call)
    assert stand_in_order(wanted, message), message
    assert message.isprintable()
    assert not LIST.search(message), message
    assert len(message) < 400, message
    assert not list(tmp_path.iterdir())


MEANT: list[tuple[Callable[[], Any], Any]] = [
    (lambda: slab(thickness="10 km").thickness, 1e4),
    (lambda: slab(thickness=np.float32(1e4)).thickness, 1e4),
    (lambda: slab(thickness=np.array(1e4)).thickness, 1e4),
    (lambda: slab(normal_stress="100 N/mm²").normal_stress, 1e8),
    (lambda: problem(pull_rate="5 cm/yr").pull_rate, 5e-2 / ss.YEAR),
    (lambda: ss.ElasticSlab(2800, 3500, 1e4, 1e8) == SLAB, True),
    (lambda: ss.loading.Steps(np.array([0, 1]), (1, 2)).values, (1.0, 2.0)),
    (lambda: float(run().slip("2 s")) == float(run().slip(2)), True),
    (lambda: run().slip([0, 1, 2]).shape, (3,)),
    (lambda: run().slip((0, 1)).shape, (2,)),
    (lambda: ss.simulate(PROBLEM, "0.1 min").duration, 6.0),
]
"""Calls that can be understood, and what they give."""


@pytest.mark.parametrize(("call", "value"), MEANT)
def test_what_can_be_understood_is_taken(call: Callable[[], Any], value: Any) -> None:
    assert call() == (pytest.approx(value, rel=1e-15) if isinstance(value, float) else value)
