"""Settings of the explorer: their controls, links, files, code, files, and the difference of two of them."""

import base64
import json
import tomllib
import zlib
from dataclasses import replace
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.controls import Control, controls_of, unit_of
from stickslip.extensions.explorer.model.difference import difference, toml_of
from stickslip.extensions.explorer.model.exchange import with_kind
from stickslip.extensions.explorer.model.ranges import range_of
from stickslip.extensions.explorer.model.setting import LONGEST_SETTING, Setting, parameters_of, setting_of
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.page.controls import FIRST_SCENARIO, offered, with_expression
from stickslip.extensions.explorer.page.files import opened
from stickslip.foundation.errors import InputError
from stickslip.friction import LAWS
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.scenario import read_scenario
from tests.problems import of_each_kind

NAMES = library.in_1d()
KINDS = of_each_kind(NAMES)


def everywhere(test):
    """Run a test for a bundled scenario of every kind."""
    return pytest.mark.parametrize("name", KINDS)(test)


def controls(setting: Setting) -> dict[str, Control]:
    """Return all controls of a setting by their paths."""
    return {control.path: control for group in controls_of(setting) for control in group.controls}


@cache
def exchanged(name: str) -> tuple[Setting, ...]:
    """Return a bundled scenario, and all settings that one exchange of a kind makes of it."""
    setting = Setting.bundled(name)
    return (setting, *(with_kind(setting, group.table, kind) for group in controls_of(setting) for kind in group.kinds))


def one_line(error: pytest.ExceptionInfo[InputError]) -> str:
    """Return the message of an error, which must be one short line in ASCII."""
    text = str(error.value)
    assert "\n" not in text
    assert text.isascii()
    assert len(text) < 800  # a list of all that is allowed may be long
    return text


# ---- controls ---------------------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=13)
@everywhere
def test_what_a_field_shows_reads_back(name: str) -> None:
    setting = Setting.bundled(name)
    for path, control in controls(setting).items():
        if control.kind in ("number", "whole") and isinstance(control.value, float | int):
            again = controls(setting.with_value(path, control.read(control.shown)))[path]
            assert again.value == pytest.approx(control.value, rel=1e-11, abs=1e-300)
            assert (again.unit, again.size, again.slider) == (control.unit, control.size, control.slider)


@pytest.mark.sampled(every=13)
@everywhere
def test_sliders_hold_the_value_and_what_they_give_is_read(name: str) -> None:
    setting = Setting.bundled(name)
    for path, control in controls(setting).items():
        if control.slider is None:
            continue
        low, high, log = control.slider
        assert low < high
        assert low <= control.value <= high or np.isinf(control.value)
        assert low > 0.0 or not log
        for end in (low, high):
            moved = setting.with_value(path, control.entry(end))
            try:
                again = controls(moved)[path]
            except InputError:  # such as a static coefficient below the dynamic one
                continue
            assert again.value == pytest.approx(end, rel=1e-9)
            assert again.slider == control.slider


@pytest.mark.parametrize(
    ("path", "anchor", "low", "high"),
    [
        ("initial.load", -6e7, -9e7, 1.04e8),
        ("initial.excess", 1e6, -5e6, 5e6),
        ("initial.excess", 0.0, -1.6e7, 1.6e7),
        ("contact.patches[0].y[1]", -18e3, -36e3, 36e3),
    ],
)
def test_range_of_a_slider_follows_from_the_first_value(path: str, anchor: float, low: float, high: float) -> None:
    problem = ss.load_scenario("fig6-slab").problem
    found = range_of(path, SimpleNamespace(whole=False), anchor, problem)
    assert (found.low, found.high) == pytest.approx((low, high), rel=1e-12, abs=0)


def test_number_in_an_unknown_unit_is_shown_in_si() -> None:
    assert unit_of("3 km", 3e3, "m") == ("km", 1e3)
    assert unit_of("3 cubits", 3.0, "m") == ("m", 1.0)


def test_exchanged_law_that_never_sticks_begins_at_its_own_friction() -> None:
    found = with_kind(Setting.bundled("fig6-slab"), "friction", "rate-and-state").value("initial")
    assert found["load"] == LAWS["rate-and-state"].start["coefficient"] * 1e8


def test_a_field_forbids_backward_slip_where_the_law_sticks() -> None:
    setting = Setting.bundled("fig6-slab")
    field = controls(setting)["loading.one_way"]
    assert (field.value, field.choices, field.rare) == ("false", ("true", "false"), True)
    forbidden = setting.with_value("loading.one_way", field.read("true"))
    assert forbidden.scenario().problem.one_way
    assert controls(forbidden)["loading.one_way"].value == "true"
    assert "loading.one_way" not in controls(Setting.bundled("rate-and-state-slab"))


def test_entries_are_written_with_the_unit_in_which_they_were_given() -> None:
    setting = Setting.bundled("fig6-slab")
    thickness = controls(setting)["body.thickness"]
    assert (thickness.shown, thickness.unit, thickness.size) == ("10", "km", 1000.0)
    assert thickness.entry(12300.0) == "12.3 km"
    assert thickness.read("7") == "7.0 km"
    assert thickness.read(" 700 m ") == "700 m"
    assert controls(setting)["body.driver_impedance"].shown == "rigid"
    assert controls(setting)["run.creep_rtol"].read("") is None
    assert controls(setting)["run.events"].read("3") == 3


@pytest.mark.parametrize(
    ("path", "typed", "part"),
    [
        ("body.thickness", "-3", "thickness: it must be greater than 0 m"),
        ("body.thickness", "", "thickness: it must be a number in m"),
        ("friction.static", "nan", "static: it must be finite"),
        ("friction.static", "0,8", "static: it must be a number"),
        ("run.events", "1.5", "slip events: number must be a whole number above 0"),
    ],
)
def test_bad_entry_is_refused_in_one_line(path: str, typed: str, part: str) -> None:
    with pytest.raises(InputError) as error:
        controls(Setting.bundled("fig6-slab"))[path].read(typed)
    assert part in one_line(error)


@pytest.mark.sampled(every=26)
@everywhere
def test_every_exchange_of_a_kind_makes_a_scenario(name: str) -> None:
    for setting in exchanged(name):
        assert setting.scenario().problem
        assert controls_of(setting)


def test_groups_say_their_kinds_where_these_can_be_exchanged_or_are_those_of_a_part() -> None:
    kinds = {group.table: group.kind for group in controls_of(with_kind(Setting.bundled("fig6-slab"), "friction", "sum"))}
    tables = {"body": "elastic-slab", "friction": "sum", "loading": "constant", "initial": "excess", "run": ""}
    assert kinds == tables | {"friction.slip": "linear-slip-weakening", "friction.rate": "exponential-stribeck"}


def test_exchange_keeps_what_fits() -> None:
    setting = Setting.bundled("fig6-slab").with_value("friction.static", 0.75)
    changed = with_kind(setting, "friction", "exponential-stribeck")
    assert changed.value("friction.static") == 0.75
    assert changed.value("friction.dynamic") == 0.3
    assert changed.value("friction.rate") == "0.1 m/s"
    assert changed.value("initial.excess") == 0.0
    assert with_kind(changed, "friction", "hyperbolic-rate").document == setting.document


def test_exchange_of_the_start_keeps_the_load() -> None:
    setting = with_kind(Setting.bundled("fig6-slab"), "initial", "load")
    assert setting.value("initial.load") == 80e6
    assert setting.value("initial.excess") is None


def test_a_start_in_motion_is_steady_sliding_or_the_same_load_and_state() -> None:
    def shown(setting: Setting) -> dict[str, object]:
        group = next(group for group in controls_of(setting) if group.table == "initial")
        return {"kind": group.kind, "kinds": group.kinds} | {one.path: one.empty or one.value for one in group.controls}

    steady = Setting.bundled("velocity-steps-block")
    kinds = ("steady", "load")
    assert shown(steady) == {"kind": "steady", "kinds": kinds, "initial.slip": "0", "initial.rate": "the pull rate"}
    loaded = with_kind(steady, "initial", "load")
    assert loaded.value("initial.load") == pytest.approx(30e3, rel=1e-15)
    assert loaded.value("initial.state") == pytest.approx(10.0, rel=1e-15)
    assert (shown(loaded)["kind"], shown(loaded)["initial.rate"]) == ("load", "load and friction balance")
    assert loaded.scenario().problem.rate == pytest.approx(1e-6, rel=1e-12)
    assert with_kind(loaded, "initial", "steady").document == steady.document
    sticks = shown(with_kind(steady, "friction", "hyperbolic-rate"))
    assert (sticks["kind"], sticks["initial.rate"]) == ("excess", "rest")


def test_exchange_of_the_body_goes_to_the_equivalent_block_and_back() -> None:
    setting = Setting.bundled("fig6-slab")
    block = with_kind(setting, "body", "spring-block")
    assert block.scenario().problem.body == ss.scenarios["fig6-slab"].problem.body.equivalent_block()
    assert with_kind(block, "body", "elastic-slab").scenario().problem == setting.scenario().problem


def start_of(setting: Setting) -> dict[str, Control]:
    """Return the controls of the start by their paths."""
    return next({one.path: one for one in group.controls} for group in controls_of(setting) if group.table == "initial")


def test_a_contact_with_inertia_that_sticks_has_a_field_for_its_rate_and_a_contact_without_has_none() -> None:
    slab = Setting.bundled("fig6-slab")
    assert "initial.rate" not in start_of(slab)
    heavy = slab.with_value("body.contact_mass", 1e5)
    assert (start_of(heavy)["initial.rate"].value, start_of(heavy)["initial.rate"].empty) == (None, "rest")
    thrown = heavy.with_value("initial.rate", "2 m/s")
    assert thrown.scenario().problem.rate == 2.0
    slider = start_of(thrown)["initial.rate"].slider
    assert slider is not None
    assert slider.low < 2.0 < slider.high


def test_the_rate_stays_when_the_load_is_given_in_another_way() -> None:
    thrown = with_kind(Setting.bundled("fig6-slab"), "body", "spring-block").with_value("initial.rate", "2 m/s")
    loaded = with_kind(thrown, "initial", "load")
    assert loaded.value("initial") == {"slip": 0.0, "rate": "2 m/s", "load": thrown.scenario().problem.load}
    back = with_kind(loaded, "initial", "excess")
    assert back.value("initial") == {"slip": 0.0, "rate": "2 m/s", "excess": 0.0}


@pytest.mark.parametrize("kind", ["load", "excess"])
def test_steady_sliding_of_a_contact_that_sticks_becomes_its_load_and_its_rate(kind: str) -> None:
    heavy = Setting.bundled("fig6-slab").with_value("body.contact_mass", 1e5).with_value("loading.pull_rate", 10.0)
    steady = heavy.with_value("initial", {"rate": "steady"})
    found, before = with_kind(steady, "initial", kind).scenario().problem, steady.scenario().problem
    assert (found.rate, found.load) == (10.0, pytest.approx(before.load, rel=1e-15))


@pytest.mark.parametrize("table", ["body", "friction", "loading", "initial"])
def test_unknown_kind_is_refused_in_one_line(table: str) -> None:
    with pytest.raises(InputError) as error:
        with_kind(Setting.bundled("fig6-slab"), table, "nonsense\n")
    one_line(error)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(
    "name", ["fig6-slab", "fig5-slab-printed", "fig6-block-reconstructed", "stress-pulse-slab", "direct-shear-block"]
)
def test_random_settings_give_an_answer_or_one_line(name: str) -> None:
    rng, answers = np.random.default_rng(7), 0
    began = Setting.bundled(name)
    sliders = [control for control in controls(began).values() if control.slider is not None and control.path != "run.duration"]
    for _ in range(5):
        setting = began
        for control in rng.choice(np.array(sliders, object), 3, replace=False):
            low, high, log = control.slider
            share = rng.uniform()
            setting = setting.with_value(
                control.path, control.entry(low * (high / low) ** share if log else low + share * (high - low))
            )
        try:
            found = solve(setting.scenario())
        except InputError:
            continue
        answers += 1
        assert all(np.all(np.isfinite(one)) for motion in found.motions for one in (motion.slip, motion.slip_rate, motion.traction))
        assert "nan" not in found.sentence
    assert answers >= 2


def test_scenarios_are_offered_once_each_with_the_paper_first() -> None:
    found = offered()
    assert sorted(one.name for one in found) == NAMES
    sections = list(dict.fromkeys(one.section for one in found))
    assert sections[0] == "The source paper"
    assert sections[1:] == sorted(sections[1:])
    assert [one.section for one in found] == sorted((one.section for one in found), key=sections.index)
    assert all(one.title and one.description for one in found)
    assert FIRST_SCENARIO in NAMES


# ---- links ------------------------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=13)
@everywhere
def test_links_reproduce_every_setting(name: str) -> None:
    for setting in exchanged(name):
        again = setting_of(parameters_of(setting) | {"cursor": "3.2", "token": "secret"})
        assert again.document == setting.document
        assert again.scenario() == setting.scenario()


def test_link_to_a_changed_scenario_is_readable() -> None:
    setting = Setting.bundled("fig6-slab").with_value("friction.alpha", "0.7 s/m").with_value("run.events", 3)
    assert parameters_of(setting) == {"scenario": "fig6-slab", "friction.alpha": "0.7 s/m", "run.events": "3", "v": "1"}


def test_link_to_a_scenario_of_the_user_holds_its_document() -> None:
    setting = replace(Setting.bundled("fig6-slab").with_value("title", "Mine: 50 % & more"), name="mine")
    parameters = parameters_of(setting)
    assert set(parameters) == {"scenario", "document", "v"}
    assert setting_of(parameters) == setting


@pytest.mark.parametrize("text", ["0.5", "7", "0.5 + 0.1/(1+v)", "(0.5)"])
def test_formulas_that_look_like_something_else_survive_a_link(text: str) -> None:
    setting = with_expression(Setting.bundled("fig6-slab"), text)
    assert setting_of(parameters_of(setting)).document == setting.document


@pytest.mark.parametrize("text", ["true", "null", '"quoted"', "[1]", "{", "", "-", "1e5", "NaN"])
def test_texts_that_look_like_something_else_survive_a_link(text: str) -> None:
    setting = Setting.bundled("fig6-slab").with_value("friction.alpha", text)
    with pytest.raises(InputError) as own:
        setting.scenario()
    with pytest.raises(InputError) as linked:
        setting_of(parameters_of(setting))
    assert str(linked.value) == str(own.value)


BOMB = base64.urlsafe_b64encode(zlib.compress(b'"' + b"a" * 50_000_000 + b'"', 9)).decode()
DEEP = base64.urlsafe_b64encode(zlib.compress(b"[" * 100_000, 9)).decode()


@pytest.mark.parametrize(
    ("parameters", "part"),
    [
        ({}, "no bundled scenario"),
        ({"scenario": "fig6-slob"}, "did you mean 'fig6-slab'?"),
        ({"scenario": "fig6-slab", "v": "99"}, "version '99' is unknown"),
        ({"scenario": "fig6-slab", "friction.alpha": "loud"}, "[friction] alpha"),
        ({"scenario": "fig6-slab", "friction.alpah": "1"}, "did you mean 'alpha'?"),
        ({"scenario": "fig6-slab", "friction.file": "/etc/passwd"}, "[friction] file is unknown"),
        ({"scenario": "fig6-slab", "friction.alpha.x": "1"}, "not the place of an entry"),
        ({"scenario": "fig6-slab", "friction.alpha": "1" * LONGEST_SETTING}, "more than"),
        ({"scenario": "mine", "document": "AAAA"}, "broken or too large"),
        ({"scenario": "mine", "document": BOMB[:LONGEST_SETTING]}, "link:"),
        ({"scenario": "mine", "document": DEEP}, "broken or too large"),
        ({"scenario": "", "document": "AAAA"}, "name"),
        ({"scenario": "mine", "document": base64.urlsafe_b64encode(zlib.compress(b"{}")).decode()}, "[body] is missing"),
    ],
)
def test_bad_link_is_refused_in_one_line(parameters: dict[str, str], part: str) -> None:
    with pytest.raises(InputError) as error:
        setting_of(parameters)
    assert part in one_line(error)


def test_document_that_unpacks_to_more_than_allowed_is_not_unpacked() -> None:
    packed = base64.urlsafe_b64encode(zlib.compress(json.dumps({"body": "a" * 2_000_000}).encode(), 9)).decode()
    assert len(packed) < LONGEST_SETTING
    with pytest.raises(InputError, match="too large"):
        setting_of({"scenario": "mine", "document": packed})


def test_setting_that_is_too_large_for_a_link_says_so() -> None:
    rng = np.random.default_rng(1)
    rates = np.cumsum(rng.uniform(0.001, 0.01, 3000))
    rows = "\n".join(f"{rate},{0.6 - 1e-4 * k}" for k, rate in enumerate(rates))
    setting = opened("many.csv", f"slip_rate,friction\n{rows}".encode(), Setting.bundled("fig6-slab"))
    with pytest.raises(InputError, match="too large for a link"):
        parameters_of(setting)


# ---- files ------------------------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=13)
@everywhere
def test_scenario_file_makes_the_same_problem(name: str) -> None:
    for setting in exchanged(name):
        scenario = setting.scenario()
        again = read_scenario(toml_of(setting), "written.toml")
        assert replace(again, description="") == replace(scenario, description="")


def test_changed_scenario_says_so_wherever_it_goes() -> None:
    setting = Setting.bundled("fig6-slab").with_value("friction.alpha", "0.7 s/m")
    assert tomllib.loads(toml_of(setting))["description"] == "fig6-slab with friction.alpha = 0.7 s/m"
    assert setting.scenario().title.endswith(", changed")
    assert "changed" not in toml_of(Setting.bundled("fig6-slab"))


# ---- files that are opened, formulas ---------------------------------------------------------------------------------------


def test_opened_scenario_with_a_bundled_name_is_not_taken_for_the_bundled_one() -> None:
    made = opened("fig6-slab.toml", library.text("kolsky-slab").encode(), Setting.bundled("fig6-slab"))
    assert made.name == "fig6-slab (opened)"
    assert not made.is_changed
    assert setting_of(parameters_of(made)) == made


def test_formula_brings_its_parameters() -> None:
    setting = with_expression(Setting.bundled("fig6-slab"), "mu_d + (mu_s - mu_d)/(1 + alpha*v)")
    assert setting.value("friction.parameters.alpha") == "1 s/m"
    other = with_expression(setting, "mu_d + 1e-3*drop/(1 + v)")
    assert set(other.value("friction.parameters")) == {"mu_d", "drop"}
    assert other.value("friction.parameters.drop") == 1.0
    assert with_expression(other, "0.5").value("friction.parameters") is None


@pytest.mark.parametrize("text", ["", "0.3 +", "__import__('os').system('ls')", "u.real", "lambda: 0", "x" * 2000, "v**1000", "é"])
def test_bad_formula_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(InputError) as error:
        with_expression(Setting.bundled("fig6-slab"), text).scenario()
    assert "expression" in one_line(error)


# ---- differences ------------------------------------------------------------------------------------------------------------


@cache
def shown(setting_alpha: str) -> tuple[Setting, Answer]:
    """Return fig6-slab with another alpha, and its answer."""
    setting = Setting.bundled("fig6-slab").with_value("friction.alpha", setting_alpha)
    return setting, solve(setting.scenario())


def test_difference_names_what_was_changed_and_what_moved() -> None:
    found = difference(shown("1 s/m"), shown("0.7 s/m"))
    assert [str(change) for change in found.changes] == ["friction.alpha: 1 s/m → 0.7 s/m"]
    moved = {one.name: one for one in found.moved}
    assert moved["slip in all"].after < moved["slip in all"].before
    assert moved["slip in all"].share == pytest.approx(-0.104, abs=2e-3)
    assert "slip events" not in moved
    assert found.text.startswith("friction.alpha: 1 s/m → 0.7 s/m. Moved: slip in all")


def test_the_same_number_in_other_words_is_no_difference() -> None:
    (old, answer), (new, other) = shown("1 s/m"), shown("1000 ms/m")
    assert difference((old, answer), (new, other)).text == "the same setting"
    assert difference((old, answer), (old.with_value("title", "x"), answer)).changes == ()


def test_difference_of_kinds_is_named_too() -> None:
    old, answer = shown("1 s/m")
    new = with_kind(old, "friction", "coulomb")
    found = difference((old, answer), (new, solve(new.scenario())))
    assert "friction.kind: hyperbolic-rate → coulomb" in found.text
    assert any(change.path == "friction.alpha" and change.after == "" for change in found.changes)


def test_a_driver_that_changes_has_controls_and_stays_behind_when_the_body_is_exchanged() -> None:
    let_go = {"kind": "steps", "times": [0, "3 s"], "values": [-1, 1]}
    setting = Setting.bundled("fig6-slab").with_value("loading.far_stress", 0.0).with_value("loading.driver_reflection", let_go)
    assert setting.scenario().problem.driver_changes
    shown = {control.path for group in controls_of(setting) for control in group.controls}
    assert {"loading.far_stress", "loading.driver_reflection.times", "loading.driver_reflection.values"} <= shown
    block = with_kind(setting, "body", "spring-block")
    assert block.value("loading.driver_reflection") is None
    assert block.scenario().problem.body.kind == "spring-block"
