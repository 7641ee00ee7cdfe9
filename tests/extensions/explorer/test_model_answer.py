"""The answers of the explorer: for every bundled scenario they show what `simulate` calculates."""

import math
from dataclasses import replace
from functools import cache, partial
from types import SimpleNamespace

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.history.history import History
from stickslip.engine.session import SPARE
from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.findings import CAUSES, MOST_EVENTS, _jump
from stickslip.extensions.explorer.model.pictures import COLUMNS, ROWS, _path, energy_picture, law_picture, slab_picture
from stickslip.extensions.explorer.model.sampled_waves import EVEN, PHASES, TRIPS, SampledWaves, ShownInterval
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import EVEN_TIMES, MOST_PIECES, Stopped, companion_of, solve
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.scenario import Scenario
from stickslip.solution.observables.asked import Field
from stickslip.solution.observables.energy.balance import energies
from tests.problems import of_each_kind, scaled_rate

NAMES = [
    *(name for name in of_each_kind(library.in_1d()) if name != "rate-and-state-block"),
    *("fig5-slab-reconstructed", "fig6-block-reconstructed", "second-event-maximal"),
]
"""A bundled scenario of every kind but one, which takes a second to answer (it is the one that is stopped), and some with more."""
SLABS = [name for name in NAMES if "slab" in name or name.startswith(("fig4", "second"))]
POINTS = 8_000
"""Largest number of points of one curve."""


@cache
def answer(name: str) -> Answer:
    """Return the answer to a bundled scenario."""
    return solve(Setting.bundled(name).scenario())


def on_slabs(test):
    """Run a test for scenarios with a slab."""
    return pytest.mark.sampled(every=3)(pytest.mark.parametrize("name", SLABS)(test))


LONG = "pipe-and-collar"
"""Takes seconds to answer, and is left to the slow tests, as other bodies of layers are among the samples."""


def everywhere(test):
    """Run a test for bundled scenarios."""
    names = [pytest.param(name, marks=pytest.mark.slow) if name == LONG else name for name in NAMES]
    return pytest.mark.sampled(every=7)(pytest.mark.parametrize("name", names)(test))


@everywhere
def test_run_is_that_of_simulate_bit_for_bit(name: str) -> None:
    own, other = answer(name).solution, ss.simulate(name)
    assert own.history.store.pieces.tobytes() == other.history.store.pieces.tobytes()
    assert own.status == other.status


@everywhere
def test_curves_are_those_of_the_solution_between_their_points_too(name: str) -> None:
    found = answer(name)
    for motion, solution in zip(found.motions, (found.solution, found.companion), strict=False):
        first, last = solution.history.span
        times = np.random.default_rng(1).uniform(first, last, 50)
        assert np.all(np.diff(motion.time) >= 0.0)
        assert motion.slip[-1] == solution.slip(last)
        # Of a run with more pieces than points the smallest and largest values of each interval are drawn: no wider than a pixel.
        edges = np.union1d(solution.breaks, solution.history.echo_edges(first, last, EVEN_TIMES))
        width = (last - first) / EVEN_TIMES if len(edges) > EVEN_TIMES else 0.0
        near = solution.slip(np.clip(times + width * np.linspace(-1.0, 1.0, 101)[:, None], first, last))
        drawn, tolerance = np.interp(times, motion.time, motion.slip), 2e-3 * max(np.ptp(motion.slip), 1e-12)
        assert np.all(drawn >= near.min(axis=0) - tolerance)
        assert np.all(drawn <= near.max(axis=0) + tolerance)
        assert len({len(motion.time), len(motion.slip), len(motion.slip_rate), len(motion.traction), len(motion.load)}) == 1
        assert len(motion.time) <= POINTS


@everywhere
def test_path_lies_on_the_contact_equation(name: str) -> None:
    found = answer(name)
    if found.contact is None:
        assert found.solution.problem.body.has_inertia or found.solution.problem.friction.state is not None
        return
    if found.solution.problem.friction.depends_on_slip:
        return
    contact, unique = found.contact, ss.uniqueness(found.scenario)
    known = ~np.isnan(contact.path_rate)
    rate, load = contact.path_rate[known], contact.path_load[known]
    moving = rate != 0.0
    assert load[moving] == pytest.approx(unique.g(rate[moving]), rel=1e-9, abs=1e-9 * contact.strength)
    # Late in a run the limit before a jump may be that after the echo which caused it: times are rounded.
    settled = (~np.isnan(np.append(contact.path_rate[1:], 0.0)))[known]
    assert np.all(np.abs(load[~moving & settled]) <= contact.strength * (1.0 + 1e-9))
    assert len(contact.path_time) == len(contact.path_rate) == len(contact.path_load)
    assert np.abs(rate).max() <= np.nanmax(contact.rate)
    curve = ~np.isnan(contact.rate)
    assert contact.load[curve][-1] == pytest.approx(unique.g(contact.rate[curve][-1]), rel=1e-12)


@everywhere
def test_parts_of_the_energy_balance_and_are_those_of_the_run(name: str) -> None:
    found = answer(name)
    parts = {part: values for part, values in found.energy.parts.items() if part != "total"}
    size = max(float(np.ptp(values)) for values in parts.values()) or 1.0
    rounding = 3e-4 if found.solution.problem.body.has_waves else 1e-9  # the waves of a slab are sampled
    assert sum(parts.values()) == pytest.approx(found.energy.parts["total"], abs=rounding * size)
    shown = ShownInterval.of(found.solution)
    chosen = np.linspace(0, len(found.energy.time) - 1, 5).astype(int)
    history = shown.readings.history
    exact = energies(history, history.find(np.minimum(found.energy.time[chosen] - shown.begin, history.span[1]), "right"))
    assert parts["kinetic"][chosen] == pytest.approx(exact["kinetic"], abs=4e-3 * size)
    for part in set(parts) - {"kinetic"}:
        was, now = (values - values[0] for values in (exact[part], parts[part][chosen]))
        assert now == pytest.approx(was, abs=4e-3 * size)


@on_slabs
def test_energy_of_a_wrong_history_shows_a_gap_between_the_parts_and_the_total(name: str) -> None:
    """Slip rates that are 10 % too high: the contact sends other waves than its load and its law allow."""
    run = answer(name).solution
    own = run.history
    wrong = History(scaled_rate(own.store, 1.1), run.problem, own.round_trip_time, own.ramp, own.duration)
    shown = ShownInterval.of(replace(run, history=wrong))
    found = energy_picture(shown, SampledWaves(shown)).parts
    stack = sum(values for part, values in found.items() if part != "total")
    assert np.abs(stack - found["total"]).max() > 0.01 * np.ptp(found["total"])


def test_mass_of_the_contact_has_its_share_of_the_kinetic_energy() -> None:
    found = solve(ss.load_scenario("fig6-slab").with_values({"body.contact_mass": 1e6, "run.duration": 4.0}))
    picture, run = found.energy, found.solution
    exact = energies(run.history, run.history.find(picture.time, "right"))
    np.testing.assert_allclose(picture.parts["kinetic"], exact["kinetic"], rtol=0, atol=2e-2 * exact["kinetic"].max())


@pytest.mark.parametrize(("cause", "end"), [("start", ""), ("fold", " at 2 s")])
def test_jump_says_when_it_is_unless_at_the_start(cause: str, end: str) -> None:
    shock = SimpleNamespace(rate_before=0.0, rate_after=1.0, time=2.0, cause=cause)
    assert _jump(shock, "m/s") == f"from rest to 1 m/s {CAUSES[cause]}{end}"


def test_path_of_a_run_is_cut_where_the_slip_rate_jumps() -> None:
    motion = SimpleNamespace(
        time=np.array([0.0, 1.0, 1.0, 1.0, 2.0]), slip_rate=np.array([0.0, 0.0, 0.5, 0.5, 0.6]), load=np.ones(5)
    )
    time, rate, load = _path(motion)
    assert time.tolist() == [0.0, 1.0, 1.0, 1.0, 1.0, 2.0]
    assert np.isnan(rate).tolist() == np.isnan(load).tolist() == [False, False, True, False, False, False]


def test_law_of_slip_and_slip_rate_is_drawn_along_the_rate() -> None:
    hardens = ss.friction.PiecewiseLinearSlip(slips=(0.0, 100.0), coefficients=(0.0, 5.0))
    law = ss.friction.SlipPlusRate(hardens, ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0))
    problem = replace(ss.load_scenario("fig6-slab").problem, friction=law)
    motion = SimpleNamespace(slip_rate=np.array([0.0, 1.0]))
    assert law_picture(ss.simulate(problem, 0.1), motion).along == "slip_rate"


def test_sentence_names_the_largest_of_two_events() -> None:
    assert "slip events, the largest of" in solve(replace(ss.load_scenario("cycles-block"), max_events=2)).sentence
    assert "One slip event of" in solve(replace(ss.load_scenario("cycles-block"), max_events=1)).sentence


@on_slabs
def test_inside_of_the_slab_is_the_field_of_the_run(name: str) -> None:
    found, shown = answer(name), ShownInterval.of(answer(name).solution)
    slab = found.slab
    time = np.linspace(shown.start, shown.end, len(slab.time))
    edges = np.concatenate([time[:1], (time[1:] + time[:-1]) / 2, time[-1:]])

    def field(at: Floats) -> Field:
        return shown.readings.field(slab.place[::6], at[::24, None])

    moved = field(time).displacement - shown.readings.field(slab.place[::6], shown.start).displacement
    miss = np.abs(slab.displacement[::24, ::6] - moved) / (np.ptp(moved) or 1.0)
    assert np.mean(miss > 2e-3) < 0.02
    for name_of, own in (("velocity", slab.velocity[::24, ::6]), ("stress", slab.stress[::24, ::6])):
        parts = [getattr(field(edges[:-1] + share * np.diff(edges)), name_of) for share in np.linspace(0.0, 1.0, 5)]
        size = np.ptp(parts) or 1.0
        is_passed = np.ptp(parts, axis=0) > 0.05 * size  # by a wave front
        mean = np.tensordot([7.0, 32.0, 12.0, 32.0, 7.0], parts, axes=1) / 90.0  # Boole's rule
        miss = np.where(is_passed, 0.0, np.abs(own - mean) / size)
        assert np.mean(miss > 2e-3) < 0.02, name_of
        least, most = np.min(parts, axis=0), np.max(parts, axis=0)
        assert np.mean((own < least - 0.05 * size) | (own > most + 0.05 * size)) < 0.02, name_of
    assert slab.time.size <= 240
    assert slab.place.size <= 80
    for front in slab.fronts:
        assert set(np.round(front[:, 1] / slab.place[-1], 12)) <= {0.0, 1.0}


def test_wave_fronts_in_the_picture_of_the_slab_follow_their_characteristics_within_a_hundredth_of_a_cell() -> None:
    found = answer("fig6-slab")
    body, slab, cell = found.solution.problem.body, found.slab, np.diff(found.slab.time)[0]
    lasts = np.full(slab.time.size, cell)
    lasts[[0, -1]] = cell / 2
    rate = found.motions[0].slip_rate.max()
    expected = 2.0 * (body.thickness - slab.place) / body.wave_speed  # from the front that goes up to the one that returns
    assert np.abs(lasts @ slab.velocity / rate - expected).max() < 0.01 * cell


def test_fronts_start_where_slip_does() -> None:
    fronts = answer("fig4-loop").slab.fronts
    assert sorted(front[0, 0] for front in fronts) == pytest.approx([2.242991, 5.213], rel=1e-3)


@everywhere
def test_marks_are_moments_of_the_run_in_order(name: str) -> None:
    found = answer(name)
    times = [mark.time for mark in found.marks]
    first, last = found.solution.history.span
    assert times == sorted(times)
    assert all(first <= time <= last for time in times)
    assert all(mark.text and "\n" not in mark.text for mark in found.marks)
    assert len(found.marks) <= 120


def test_pulses_are_marked_at_their_peaks() -> None:
    found = answer("fig5-slab-reconstructed")
    pulses = [mark.time for mark in found.marks if mark.kind == "pulse"]
    assert len(pulses) == 3 == found.solution.events.pulses[0]
    assert max(found.solution.slip_rate(np.array(pulses))) == pytest.approx(found.solution.events.peak_rate[0], rel=1e-3)


@everywhere
def test_law_is_drawn_over_all_that_the_run_passed(name: str) -> None:
    law, problem = answer(name).law, answer(name).solution.problem
    assert np.all(np.diff(law.x) > 0.0)
    assert law.log or law.x[0] <= law.visited[0]
    assert law.along == "slip" or law.visited[0] >= 0.0 or (answer(name).solution.history.store.mode < 0).any(), "no rounding"
    assert law.x[-1] >= law.visited[1]
    assert law.x.size <= POINTS
    if law.along == "slip":
        assert law.coefficient == pytest.approx(problem.friction.static_coefficient(law.x))
    elif problem.friction.state is None:
        assert law.coefficient == pytest.approx(problem.friction.coefficient(problem.law_slip, law.x))


@everywhere
def test_key_numbers_are_those_of_the_tables(name: str) -> None:
    found = answer(name)
    numbers, events = {one.name: one.value for one in found.numbers}, found.solution.events
    assert numbers["slip events"] == len(events)
    assert numbers["slip in all"] == found.solution.slip(found.solution.history.span[1]) - found.solution.problem.initial_slip
    if len(events):
        assert numbers["slip of the largest event"] == pytest.approx(events.slip.max(), rel=0.01)
    else:
        assert math.isnan(numbers["arrest"])


@everywhere
def test_sentence_says_regime_and_motion_in_full_sentences(name: str) -> None:
    found = answer(name)
    assert found.sentence.startswith(found.regime.capitalize())
    assert found.sentence.endswith(".")
    assert "nan" not in found.sentence
    assert "\n" not in found.sentence
    assert ("slip event" in found.sentence) or ("slips" in found.sentence)


@pytest.mark.parametrize(("alpha", "word"), [("0.19599 s/m", "regular"), ("0.19601 s/m", "irregular")])
def test_regime_changes_at_the_critical_alpha(alpha: str, word: str) -> None:
    found = solve(Setting.bundled("fig6-slab").with_value("friction.alpha", alpha).scenario())
    assert found.regime == word
    assert "0.196 s/m" in found.sentence
    assert 1.0 < np.nanmax(found.contact.rate) / found.motions[0].slip_rate.max() < 1.2


def test_companion_of_a_slab_is_its_equivalent_block() -> None:
    found = answer("fig6-slab")
    slab, block = found.solution.problem, found.companion.problem
    assert [motion.name for motion in found.motions] == ["slab", "equivalent block"]
    assert block.body == slab.body.equivalent_block()
    assert found.motions[1].load_unit == "N"
    assert found.motions[1].normal_load == slab.normal  # for each m^2, so that N reads as Pa


def test_companion_of_a_block_of_the_paper_is_the_slab_under_the_same_law() -> None:
    setting = Setting.bundled("fig6-block-reconstructed").with_value("friction.alpha", "0.7 s/m")
    other = companion_of(setting.scenario())
    assert other.problem.body == ss.scenarios["fig6-slab"].problem.body
    assert other.problem.friction == setting.scenario().problem.friction


@pytest.mark.parametrize("name", ["kolsky-slab", "tides-block"])
def test_what_has_no_companion_is_shown_alone(name: str) -> None:
    assert answer(name).companion is None
    assert len(answer(name).motions) == 1


def test_long_run_that_is_stopped_is_shown_up_to_there() -> None:
    lines: list[str] = []

    def told(text: str) -> None:
        lines.append(text)
        if len(lines) == 2:
            raise Stopped

    found = solve(Setting.bundled("rate-and-state-block").scenario(), told)
    end = found.solution.history.span[1]
    assert found.solution.status.name == "interrupted"
    assert 0.0 < end < found.scenario.duration
    assert found.motions[0].time[-1] == pytest.approx(end)
    assert found.notes[0].startswith("interrupted")
    assert "years" in lines[0]
    assert found.companion is None


@pytest.mark.parametrize("name", ["tides-block", "fig6-block-reconstructed", "fig6-slab"])
def test_energy_of_a_long_run_is_that_of_a_short_one(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    exact = answer(name).energy
    shown = ShownInterval.of(answer(name).solution)
    monkeypatch.setattr("stickslip.extensions.explorer.model.pictures.LONG_HISTORY", 0)
    rough = energy_picture(shown, SampledWaves(shown) if "slab" in name else None)
    assert set(rough.parts) == set(exact.parts)
    for part, values in exact.parts.items():
        assert rough.parts[part] == pytest.approx(values, abs=1e-3 * float(np.ptp(values)))


@pytest.mark.slow
def test_energy_picture_of_a_slab_on_shaken_ground_is_that_of_the_run() -> None:
    """The work of the ground is part of the total, which the parts add up to."""
    found = answer("sliding-slab-shaken")
    parts, time = found.energy.parts, found.energy.time
    exact = found.solution.energy(time)
    assert parts["heat"] == pytest.approx(exact.heat.to_numpy() - float(exact.heat[0]), abs=1e-6 * float(exact.heat[-1]))
    missing = parts["total"] - sum(values for name, values in parts.items() if name != "total")
    assert np.abs(missing).max() < 2e-3 * parts["total"].max()


def test_pictures_of_a_long_run_are_told_of_and_end_for_newer_work_but_not_for_a_stop(monkeypatch: pytest.MonkeyPatch) -> None:
    """A stop ends the run; what there is of it is shown, with all pictures."""
    monkeypatch.setattr("stickslip.extensions.explorer.model.solve.PIECES_OF_LONG_RUN", 0)
    lines: list[str] = []

    def told(text: str, end: type[BaseException]) -> None:
        lines.append(text)
        if "the run is finished" in text:
            raise end

    scenario = Setting.bundled("fig6-block-reconstructed").scenario()
    found = solve(scenario, partial(told, end=Stopped))
    assert "the run is finished; working out the energy" in lines
    assert found.energy.parts
    with pytest.raises(SystemExit):
        solve(scenario, partial(told, end=SystemExit))


def test_run_that_is_stopped_before_it_begins_is_refused_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise Stopped

    monkeypatch.setattr("stickslip.extensions.explorer.model.solve.simulate", stopped)
    with pytest.raises(InputError, match="fig6-slab: stopped before the run had begun"):
        solve(Setting.bundled("fig6-slab").scenario())


def test_memory_of_a_run_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    assert MOST_PIECES * 450 < 100e6  # bytes: 0.44 GB for a million pieces
    monkeypatch.setattr("stickslip.extensions.explorer.model.solve.MOST_PIECES", 500)
    found = solve(Setting.bundled("rate-and-state-slab").scenario())
    assert found.solution.status.name == "too many pieces"
    assert "too many pieces" in found.notes[0]
    assert len(found.solution.history) <= 500 + SPARE


def test_contact_that_rests_for_ever_is_shown() -> None:
    found = solve(Setting.bundled("fig6-slab").with_value("loading.pull_rate", 0.0).scenario())
    assert "Nothing slips" in found.sentence
    assert np.all(found.motions[0].slip_rate == 0.0)
    assert found.marks == ()


def test_backward_slip_has_the_mirror_image_of_the_contact_equation() -> None:
    setting = Setting.bundled("fig6-slab").with_value("initial.excess", None).with_value("initial.load", "-90 MPa")
    found = solve(setting.with_value("loading.pull_rate", 0.0).scenario())
    contact = found.contact
    assert found.motions[0].slip_rate.min() < 0.0
    known = ~np.isnan(contact.rate)
    assert contact.rate[known] == pytest.approx(-contact.rate[known][::-1])
    assert contact.load[known] == pytest.approx(-contact.load[known][::-1])


def test_law_of_backward_slip_is_odd_and_has_both_limits_where_friction_changes_sign() -> None:
    """mu(-v) = -mu(v): a place of its own for each slip rate but 0, where friction jumps from the one limit to the other."""
    setting = Setting.bundled("fig6-slab").with_value("initial.excess", None).with_value("initial.load", "-90 MPa")
    found = solve(setting.with_value("loading.pull_rate", 0.0).scenario())
    law, problem = found.law, found.solution.problem
    assert law.along == "slip_rate"
    assert law.x[0] < law.visited[0] < 0.0 <= law.visited[1] < law.x[-1]
    assert law.x[np.flatnonzero(np.diff(law.x) <= 0.0)].tolist() == [0.0]
    at_speed = problem.friction.coefficient(problem.law_slip, np.abs(law.x))
    assert law.coefficient == pytest.approx(np.repeat([-1.0, 1.0], len(law.x) // 2) * at_speed, rel=1e-15, abs=0.0)


@pytest.mark.parametrize(("most", "duration"), [(50, 9.5e4), pytest.param(MOST_EVENTS, 1.0e5, marks=pytest.mark.slow)])
def test_run_of_many_events_is_answered_without_a_look_at_each_pulse(
    most: int, duration: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("stickslip.extensions.explorer.model.findings.MOST_EVENTS", most)
    found = solve(Setting.bundled("fig7-slab-critical").with_value("run.duration", duration).scenario())
    assert len(found.solution.events) > 2 * most
    assert "pulse" not in {mark.kind for mark in found.marks}


def test_inside_of_the_slab_in_a_long_run_is_shown_around_its_event_in_time_of_the_run() -> None:
    setting = Setting.bundled("fig7-slab-critical").with_value("initial.excess", "-100 Pa")
    found = solve(setting.with_value("run.duration", 1.0e5).scenario())
    (event,) = found.solution.events.itertuples()
    assert event.start > 1e4
    assert found.slab.time[0] < event.start < event.end < found.slab.time[-1] < event.end + 10.0
    assert found.slab.fronts[0][0, 0] == pytest.approx(event.start, abs=1e-6)


YEARS = 1000.0
LAB = ss.ElasticSlab(2800.0, 3500.0, 1.0, 1e6)
STEADY = ss.Problem(LAB, ss.friction.FromExpression("0.6 + 0.1*v"), pull_rate=1e-3, initial_excess=10.0)
RESTING = ss.Problem(LAB, ss.friction.HyperbolicRate(0.8, 0.3, 1.0), pull_rate=5e-16, initial_excess=-7e5)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("problem", [STEADY, RESTING], ids=["slides steadily", "rests"])
def test_a_run_over_a_million_million_round_trips_is_answered_with_pictures_of_the_usual_size(problem: ss.Problem) -> None:
    found = solve(Scenario(problem, YEARS * ss.YEAR))
    assert found.solution.status.name == "finished"
    assert found.motions[0].slip[-1] == pytest.approx(YEARS * ss.YEAR * (1e-3 if problem is STEADY else 0.0), rel=1e-6)
    if problem is RESTING:  # steady sliding is leaped over: its waves are averages
        assert found.slab is not None
        assert found.slab.velocity.size == COLUMNS * ROWS
        exact = found.solution.energy(found.energy.time[[0, 80, -1]]).stored.to_numpy()
        elastic = found.energy.parts["elastic"][[0, 80, -1]]
        assert elastic - elastic[0] == pytest.approx(exact - exact[0], abs=1e-3 * exact[-1])


@pytest.mark.slow
def test_pictures_over_many_round_trips_show_means_over_one_of_the_exact_energies() -> None:
    """A rest after a slip event, whose waves go to and fro 20 000 times; it is shown whole, as the explorer would not do."""
    scenario = ss.load_scenario("fig5-slab-u0-1e-2")
    trip = scenario.problem.round_trip_time
    run, end = ss.simulate(scenario.problem, 2e4 * trip), 1.99e4 * trip
    waves = SampledWaves(ShownInterval(run, 4.0 * trip, end, 0.0))
    assert len(waves.samples.time) == TRIPS
    time = np.linspace(5.0 * trip, end - trip, 5)
    around = [run.history.find(one + trip * (np.arange(64) - 31.5) / 64, "right") for one in time]
    exact = [{name: values.mean() for name, values in energies(run.history, at).items()} for at in around]
    kinetic, stored, work = (np.array([one[name] for one in exact]) for name in ("kinetic", "stored", "work"))
    assert kinetic.min() > 1e7  # J/m^2
    assert waves.kinetic(time, 240) == pytest.approx(kinetic, rel=3e-2)
    for found, known in ((waves.stored(time), stored), (waves.work(time), work)):
        assert found - found[0] == pytest.approx(known - known[0], abs=1e-2 * kinetic.max())


@on_slabs
def test_pictures_of_means_are_those_of_waves_within_a_pixel(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    exact = answer(name)
    monkeypatch.setattr("stickslip.extensions.explorer.model.sampled_waves.MANY_PLACES", 0)
    shown = ShownInterval.of(exact.solution)
    waves = SampledWaves(shown)
    assert len(waves.samples.wave) == EVEN * PHASES
    assert exact.slab is not None
    found = slab_picture(waves)
    for own, known in ((found.velocity, exact.slab.velocity), (found.stress, exact.slab.stress)):
        assert np.abs(own - known).mean() < 5e-3 * np.ptp(known)
    size = max(float(np.ptp(values)) for values in exact.energy.parts.values())
    for part, values in energy_picture(shown, waves).parts.items():
        assert values == pytest.approx(exact.energy.parts[part], abs=1e-2 * size)
