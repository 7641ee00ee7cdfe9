"""Axes, grids, samples and lists: which members there are, in SI, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pint
import pytest

import stickslip as ss
from stickslip.extensions.sweeps.design.axis import DesignAxis, typed_axes
from stickslip.extensions.sweeps.design.design import read_design
from stickslip.extensions.sweeps.execution.plan import make_plan, tile_of
from stickslip.problem.scenarios.parameter_paths import find_parameter, parameter_paths
from stickslip.problem.scenarios.scenario import Scenario, load_scenario, read_scenario
from tests.messages import refused

SLAB = load_scenario("fig6-slab")
NESTED = load_scenario("block-or-slab")


def typed(*texts: str) -> list[DesignAxis]:
    """Return the axes that were typed on the command line."""
    return typed_axes(SLAB, texts, "--vary")


def values(text: str) -> Any:
    return read_design(SLAB, typed(text)).columns[0]


def test_a_range_is_even_or_in_equal_ratios_and_in_si() -> None:
    np.testing.assert_allclose(values("friction.alpha=0.5..2:4"), [0.5, 1.0, 1.5, 2.0], rtol=1e-15, atol=0)
    thickness = values("body.thickness=1km..100 km:3:log")
    np.testing.assert_allclose(thickness, [1e3, 1e4, 1e5], rtol=1e-14, atol=0)
    assert thickness[0] == 1e3
    assert thickness[-1] == 1e5
    np.testing.assert_array_equal(values("body.thickness=1..3 km:3"), values("body.thickness=1km..3:3"))
    np.testing.assert_array_equal(values("body.thickness=1..3 km:3"), [1e3, 2e3, 3e3])
    rates = values("loading.pull_rate=1 mm/year..1 m/year:4:log") * ss.YEAR
    np.testing.assert_allclose(rates, [1e-3, 1e-2, 1e-1, 1.0], rtol=1e-14, atol=0)


def test_a_list_is_in_si_and_keeps_its_order() -> None:
    assert values("body.thickness=20 km,1000,5e3 m").tolist() == [20e3, 1e3, 5e3]
    assert values("run.selection=maxwell, perfect-delay").tolist() == ["maxwell", "perfect-delay"]


UREG = pint.get_application_registry()
GIVEN: dict[str, tuple[str, Any, list[Any]]] = {
    "array": ("friction.alpha", np.array([1.0, 2.0]), [1.0, 2.0]),
    "whole numbers": ("friction.alpha", np.arange(1, 4), [1.0, 2.0, 3.0]),
    "single precision": ("friction.alpha", np.array([0.5, 1.5], np.float32), [0.5, 1.5]),
    "list": ("body.thickness", ["1 km", 5, 2.5], [1e3, 5.0, 2.5]),
    "generator": ("friction.alpha", (n / 2 for n in range(1, 4)), [0.5, 1.0, 1.5]),
    "series": ("friction.alpha", pd.Series([1.0, 2.0]), [1.0, 2.0]),
    "pint array": ("body.thickness", np.array([1, 2]) * UREG.km, [1e3, 2e3]),
    "pint speeds": ("loading.pull_rate", np.array([50.0, 100.0]) * UREG.m / UREG.year, [50.0 / ss.YEAR, 100.0 / ss.YEAR]),
    "pint numbers": ("body.thickness", [1 * UREG.km, UREG.Quantity(5.0, "m")], [1e3, 5.0]),
    "pint share": ("friction.dynamic", np.array([10.0, 30.0]) * UREG.percent, [0.1, 0.3]),
    "words": ("run.selection", ["perfect-delay", "minimal"], ["perfect-delay", "minimal"]),
    "array of words": ("run.selection", np.array(["maxwell", "minimal"]), ["maxwell", "minimal"]),
    "whole number of events": ("run.events", [1, 2], [1.0, 2.0]),
}


@pytest.mark.parametrize("kind", GIVEN)
def test_a_mapping_takes_arrays_lists_and_quantities(kind: str) -> None:
    name, content, expected = GIVEN[kind]
    assert read_design(SLAB, {name: content}).columns[0].tolist() == expected


def test_values_in_equal_ratios_are_logarithmic() -> None:
    for content, log in (
        (np.geomspace(1e3, 1e5, 7), True),
        ([1.0, 10.0, 100.0], True),
        (np.linspace(1.0, 2.0, 7), False),
        ([1.0, 10.0], False),
        ([1.0, 10.0, 50.0], False),
    ):
        assert read_design(SLAB, {"body.thickness": content}).logs == ({"body.thickness"} if log else set())


def test_the_end_of_a_name_is_enough() -> None:
    assert read_design(SLAB, {"alpha": [1, 2], "pull_rate": [1]}).names == ("friction.alpha", "loading.pull_rate")
    assert read_design(SLAB, typed("alpha=1,2", "pull_rate=1")).names == ("friction.alpha", "loading.pull_rate")


def test_a_grid_has_every_combination_and_its_last_axis_runs_fastest() -> None:
    design = read_design(SLAB, {"friction.alpha": [1.0, 2.0], "body.thickness": [10.0, 20.0, 30.0]})
    assert (design.shape, design.size, design.dims) == ((2, 3), 6, ("friction.alpha", "body.thickness"))
    every = design.values(slice(None))
    assert every["friction.alpha"].tolist() == [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]
    assert every["body.thickness"].tolist() == [10.0, 20.0, 30.0, 10.0, 20.0, 30.0]
    assert design.values(np.array([4]))["body.thickness"].tolist() == [20.0]


@pytest.mark.parametrize("kind", ["random", "lhs"])
def test_samples_lie_between_the_ends_and_follow_the_seed(kind: str) -> None:
    vary = {"alpha": (0.1, 10, "log"), "thickness": ("1km", 5 * UREG.km), "run.selection": ["maxwell", "minimal"]}
    design, again, other = (read_design(SLAB, vary, kind, members=1000, seed=seed) for seed in (3, 3, 4))
    text = read_design(
        SLAB, typed("alpha=0.1..10:log", "thickness=1km..5km", "run.selection=maxwell,minimal"), kind, members=1000, seed=3
    )
    assert all((one == same).all() for one, same in zip(design.columns, text.columns, strict=True))
    assert design.logs == text.logs == {"friction.alpha"}
    alpha, thickness, rule = design.columns
    assert 0.1 <= alpha.min() < 0.11
    assert 9.0 < alpha.max() <= 10.0
    assert abs(np.median(np.log10(alpha))) < 0.15  # even in the logarithm: its median would be 0.7 if it were even in alpha
    assert 1e3 <= thickness.min() < thickness.max() <= 5e3
    assert set(rule.tolist()) == {"maxwell", "minimal"}
    assert all((one == same).all() for one, same in zip(design.columns, again.columns, strict=True))
    assert not (design.columns[0] == other.columns[0]).any()
    assert design.dims == ("member",)


def test_a_latin_hypercube_has_one_member_in_each_part_of_every_axis() -> None:
    columns = {
        kind: read_design(SLAB, {"alpha": (0, 1), "static": (0.3, 0.8)}, kind, members=50, seed=1).columns
        for kind in ("lhs", "random")
    }
    parts = {
        kind: [np.unique(np.floor((c - low) / wide * 50)).size for c, low, wide in zip(two, (0, 0.3), (1, 0.5), strict=True)]
        for kind, two in columns.items()
    }
    assert parts["lhs"] == [50, 50]
    assert max(parts["random"]) < 45


def test_a_table_is_a_list_of_members(tmp_path: Path) -> None:
    path = tmp_path / "members.csv"
    path.write_text("# ours\nthickness, run.selection,friction.alpha\n1 km,maxwell,1\n2000,minimal,2e0\n")
    for table in (path, pd.DataFrame({"body.thickness": ["1 km", 2e3], "run.selection": ["maxwell", "minimal"], "alpha": [1, 2]})):
        design = read_design(SLAB, table)
        assert design.names == ("body.thickness", "run.selection", "friction.alpha")
        assert [column.tolist() for column in design.columns] == [[1e3, 2e3], ["maxwell", "minimal"], [1.0, 2.0]]
        assert (design.kind, design.dims, design.size) == ("list", ("member",), 2)


def test_keys_reach_everything_with_a_unit() -> None:
    keys = {one.name: one for one in parameter_paths(NESTED)}
    assert keys["friction.parameters.wavelength"].unit == "m"
    assert keys["friction.parameters.alpha"].unit == "m^-1 s"
    assert keys["friction.parameters.a"].unit == "1"
    assert {"body.thickness", "loading.pull_rate", "initial.excess", "run.duration", "run.rtol", "run.events"} <= set(keys)
    parts = [one.name for one in parameter_paths(load_scenario("cycles-slab"))]
    assert {"friction.memory", "body.contact_mass"} <= set(parts)


LAW = """
[friction]
kind = "sum"

[friction.slip]
kind = "piecewise-linear-slip"
slips = [0.0, 1.0]
coefficients = [0.5, 0.2]

[friction.rate]
kind = "hyperbolic-rate"
static = 0.3
dynamic = 0.2
alpha = 1.0

"""


def sum_of_laws() -> Scenario:
    text = SLAB.to_toml()
    return read_scenario(text[: text.index("[friction]")] + LAW + text[text.index("[loading]") :], "sum")


def test_keys_reach_parts_and_series_of_a_law() -> None:
    plan = make_plan(sum_of_laws(), {"friction.rate.alpha": [1, 2], "friction.slip.coefficients[1]": [0.1, 0.3]})
    member = plan.work.member({"friction.rate.alpha": 2.0, "friction.slip.coefficients[1]": 0.3})
    assert member.problem.friction.rate.alpha == 2.0  # type: ignore[attr-defined]
    assert member.problem.friction.slip.coefficients == (0.5, 0.3)  # type: ignore[attr-defined]


def test_an_ambiguous_name_is_refused_with_its_candidates() -> None:
    text = sum_of_laws().to_toml().replace('kind = "piecewise-linear-slip"', 'kind = "linear-slip-weakening"')
    text = text.replace(
        "slips = [\n    0.0,\n    1.0,\n]\ncoefficients = [\n    0.5,\n    0.2,\n]", "static = 0.4\ndynamic = 0.2\ndistance = 1.0"
    )
    with pytest.raises(ss.InputError, match=r"'static' is ambiguous: give one of friction.slip.static, friction.rate.static"):
        find_parameter(read_scenario(text, "sum"), "static", "--vary")


BAD = {
    "friction.alpa=1..2:3": "'friction.alpa' is not a parameter of this scenario; did you mean 'friction.alpha'?",
    "friction.alpha": 'must be "KEY=LOW..HIGH:POINTS"',
    "friction.alpha=1..2": "needs a number of points",
    "friction.alpha=1..2:1": "needs at least 2 points",
    "friction.alpha=1..2:99999999": "at most 10000000 are allowed",
    "friction.alpha=1..2:1e9": "friction.alpha has 1000000000 values, at most 10000000 are allowed",
    "friction.alpha=1..2:1e9:log": "friction.alpha has 1000000000 values, at most 10000000 are allowed",
    "friction.alpha=1..2:99999999999": "friction.alpha has 99999999999 values, at most 10000000 are allowed",
    f"friction.alpha=1..2:{10**99}": "friction.alpha has 1e+99 values, at most 10000000 are allowed",
    "friction.alpha=1..2:-5": "friction.alpha needs at least 2 points, got -5",
    "friction.alpha=1..2:2.5": "alpha: the number of points of a range must be a whole number, as in LOW..HIGH:40, got '2.5'",
    "friction.alpha=1..2:": "alpha: the number of points of a range must be a whole number, as in LOW..HIGH:40, got ''",
    "friction.alpha=1..2:inf": "the number of points of a range must be a whole number, as in LOW..HIGH:40, got 'inf'",
    "friction.alpha=1..2:4:lin": "the number of points of a range must be a whole number, as in LOW..HIGH:40, got '4:lin'",
    "friction.alpha=1..2:4:linear": "got '4:linear'; equal ratios end in :log, equal steps in nothing",
    "friction.alpha=1-2:5": "friction.alpha: a range is written 1..2:5, got '1-2:5'",
    "friction.alpha=1e-3-1e-2:5": "friction.alpha: a range is written 1e-3..1e-2:5, got",
    "friction.alpha=1 to 2": "friction.alpha: a range is written 1..2, got '1 to 2'",
    "friction.alpha=1:2:5": "friction.alpha: a range is written 1..2:5, got '1:2:5'",
    "friction.alpha=0.1...9:5": "friction.alpha: a range is written 0.1..9:5, got '0.1...9:5'",
    "friction.alpha=0.1; 0.2": "friction.alpha: values are written with commas, as 0.1,0.2, got '0.1; 0.2'",
    "friction.alpha=0.1 0.2": "friction.alpha: values are written with commas, as 0.1,0.2, got '0.1 0.2'",
    "friction.alpha=2..1:5": "must go from a smaller to a larger number, got 2 to 1 s/m",
    "friction.alpha=0..1:5:log": "must begin above 0",
    "friction.alpha=1..2 km:5": "'1 km': 'km' does not convert to s/m",
    "friction.alpha=1,1": "has the value 1.0 twice",
    "friction.alpha=-1..1:5": "friction.alpha must be",
    "friction.alpha=nan,1": "must be finite",
    "run.selection=maxwel": "run.selection 'maxwel' is unknown; did you mean 'maxwell'?",
    "run.selection=a..b:3": "takes words, not a range",
    "friction.alpha=1,,2": "friction.alpha must be a number",
    "body.kind=spring-block": "is not a parameter of this scenario",
}


@pytest.mark.parametrize("text", BAD)
def test_bad_axes_are_refused_in_one_line(text: str) -> None:
    with pytest.raises(ss.InputError, match=r"^--vary") as told:
        read_design(SLAB, typed(text), where="--vary")
    assert BAD[text] in str(told.value)
    assert "\n" not in str(told.value)


BAD_DESIGNS: list[tuple[dict[str, Any], str]] = [
    ({"vary": {}}, "name at least one parameter to vary"),
    ({"vary": {"alpha": [1, 2], "friction.alpha": [3]}}, "friction.alpha is varied twice"),
    ({"vary": {"initial.load": [1], "initial.excess": [1]}}, "exclude each other"),
    ({"vary": {"alpha": [1, 2]}, "kind": "lh"}, "design 'lh' is unknown"),
    ({"vary": {"alpha": [1, 2]}, "members": 5}, "members belongs to"),
    ({"vary": {"alpha": (1, 2)}, "kind": "lhs"}, "the design lhs: members must be a whole number from 1 to 10000000, got None"),
    ({"vary": {"alpha": (1, 2)}, "kind": "lhs", "members": 5, "seed": -1}, "seed must be a whole number"),
    ({"vary": typed("alpha=1..2:5"), "kind": "random", "members": 5}, "takes no number of points"),
    ({"vary": {"alpha": (2, 1)}, "kind": "lhs", "members": 5}, "must go from a smaller to a larger number, got 2 to 1 s/m"),
    (
        {"vary": {"alpha": (1, 2, 3)}, "kind": "lhs", "members": 5},
        'must be an array or a list: a tuple (LOW, HIGH) or (LOW, HIGH, "log")',
    ),
    ({"vary": {"alpha": (1, 2)}}, "friction.alpha must be an array or a list: a tuple"),
    (
        {"vary": "alpha=1,2"},
        "sweep: vary must be a mapping from parameters to arrays, a DataFrame or the Path of a CSV file, got 'alpha=1,2'",
    ),
    ({"vary": Path("no.csv")}, "no such file"),
    ({"vary": pd.DataFrame({"alpha": []})}, "has no members"),
    ({"vary": pd.DataFrame({"alpha": ["1 km"]})}, "does not convert to s/m"),
    ({"vary": {"alpha": []}}, "friction.alpha needs at least one value"),
    *(
        ({"vary": {"alpha": one}}, "sweep: vary: friction.alpha must be a one-dimensional array or a list of values, got ")
        for one in (5, 5.0, None, np.array(5.0), np.float64(5.0), 5 * UREG.s / UREG.m, "1,2", "1..2:5", {"a": 1}, np.ones((2, 99)))
    ),
    ({"vary": {"alpha": "0.05..2:40"}}, "got '0.05..2:40': use a list or numpy.linspace"),
    ({"vary": {"alpha": np.array([1.0, np.nan])}}, "sweep: vary: friction.alpha must be finite, got nan"),
    ({"vary": {"alpha": np.array([1.0, "2.0"])}}, "got '1.0': write a number without quotes"),
    ({"vary": {"alpha": np.array([True, False])}}, "friction.alpha must be a number in s/m"),
    ({"vary": {"alpha": [[1.0, 2.0], [3.0, 4.0]]}}, "friction.alpha must be a number in s/m"),
    ({"vary": {"alpha": np.array([-1.0, 1.0])}}, "friction.alpha must be at least 0 s/m, got -1"),
    ({"vary": {"alpha": [3.0, 1.0, 2.0, 3.0]}}, "friction.alpha has the value 3.0 twice"),
    ({"vary": {"alpha": [1.0, 2.0] * UREG.km}}, "sweep: vary: friction.alpha: 'kilometer' does not convert to s/m"),
    ({"vary": {"alpha": [1.0, 2.0 * UREG.km]}}, "friction.alpha: 'kilometer' does not convert to s/m"),
    ({"vary": {"run.selection": [1.0] * UREG.km}}, "run.selection takes words, got a quantity in kilometer"),
    ({"vary": {"run.selection": [1.0, 2.0]}}, "run.selection 1.0 is unknown"),
    ({"vary": {"run.selection": ["minimal", "maximum"]}}, "run.selection 'maximum' is unknown; did you mean 'maximal'?"),
    ({"vary": {7: [1.0]}}, "'7' is not a parameter of this scenario"),
]


@pytest.mark.parametrize(("asked", "said"), BAD_DESIGNS, ids=lambda one: str(one)[:40])
def test_bad_designs_are_refused_in_one_line(asked: dict[str, Any], said: str) -> None:
    with refused(said):
        read_design(SLAB, **asked)


def test_a_file_that_is_no_table_is_refused_in_one_line(tmp_path: Path) -> None:
    path = tmp_path / "members.csv"
    for content in (b"", b"\xff\xfe\x00", b"alpha\n1,2,3\n1\n", b"alpha,alpha\n1,2\n"):
        path.write_bytes(content)
        with refused():
            read_design(SLAB, path)


@pytest.mark.parametrize(
    ("shape", "size"), [((40, 30), 18), ((40, 30), 64), ((7,), 3), ((3, 4, 5), 20), ((3, 4, 5), 1), ((2, 2), 99)]
)
def test_chunks_hold_every_member_once(shape: tuple[int, ...], size: int) -> None:
    axes = {name: np.arange(1.0, n + 1.0) for name, n in zip(("alpha", "thickness", "density"), shape, strict=False)}
    plan = make_plan(SLAB, axes, chunk=size)
    found = [plan.members(chunk) for chunk in range(plan.chunks)]
    assert max(len(one) for one in found) <= size
    assert sorted(np.concatenate(found).tolist()) == list(range(plan.design.size))
    assert plan.tile == tile_of(shape, size)
