"""What people of the trades type in place of names of extensions is answered with those, and the table of words has no others."""

from __future__ import annotations

import inspect
from functools import cache
from typing import Any

import pytest

import stickslip as ss
from stickslip.cli.app import COMMANDS
from stickslip.cli.main import main
from stickslip.foundation.synonyms import last, plain, rows
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.parameter_paths import parameter_paths


@cache
def run() -> Any:
    return ss.simulate("fig6-slab")


WORDS = [
    (["gui"], "did you mean 'explore'?"),
    (["calibrate"], "did you mean 'infer'?"),
    (["scan"], "did you mean 'sweep'?"),
    (["data.csv"], "did you mean `stickslip fit data.csv` or `stickslip infer SCENARIO data.csv --free NAMES`?"),
    (["run", "fig6-slab", "--law", "coulomb"], "there is no option --law; it is an option of fit; `"),
    (["run", "fig6-slab", "--quantity", "slip"], "there is no option --quantity; it is an option of show and sweep; `"),
    (["run", "fig6-slab", "--vary", "a=1,2"], "it is an option of sweep; did you mean '--set'?"),
    (["check", "fig6-slab", "--dry-run"], "it is an option of sweep; `"),
    (["check", "fig6-slab", "-q", "slip"], "there is no option -q; it is an option of show and sweep; `"),
    (["sweep", "fig6-slab", "--param", "a=1,2"], "did you mean '--set' or '--vary'?"),
    (["find", "drill-string", "--vary", "rpm"], "it is an option of sweep; did you mean '--set' or '--along'?"),
    (["infer", "a.toml", "a.csv", "--parameters", "a,b"], "it is an option of check; did you mean '--set' or '--free'?"),
    (["infer", "a.toml", "a.csv", "--bounds", "a,b"], "did you mean '--bound'?"),
    (["--duration", "3"], "there is no option --duration; it is an option of run, export, "),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "-q", "displacement"], "did you mean 'slip'?"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "-q", "vmax"], "did you mean 'peak_rate'?"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "-q", "stress_drop"], "did you mean 'first_traction_drop' or 'first_static_drop'?"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "-q", "n_events"], "did you mean 'events'?"),
    (
        ["infer", "data.csv", "--free", "a"],
        "infer: the scenario comes first, and then the data: `stickslip infer SCENARIO data.csv ...`",
    ),
    (["infer", "data.lvm"], "infer: the scenario comes first, and then the data: `stickslip infer SCENARIO data.lvm ...`"),
    (
        ["infer", "a.csv", "b.csv", "--free", "a"],
        "and then the data: `stickslip infer SCENARIO a.csv b.csv --free",
    ),
    (
        ["infer", "a.csv", "mine.toml", "--free", "a"],
        "and then the data: `stickslip infer mine.toml a.csv --free",
    ),
    (["infer", "mine.toml"], "infer: DATA is missing, after the scenario: `stickslip infer mine.toml DATA ...`"),
    (["fit", "mine.toml"], "fit: mine.toml is a scenario, and points come first here: `stickslip fit DATA`;"),
    (["fit", "fig6-slab"], "fit: fig6-slab is a scenario, and points come first here: `stickslip fit DATA`;"),
    (["fit", "mine.toml", "a.csv"], "'a.csv' is not expected; to follow a record: `stickslip infer mine.toml a.csv --free NAMES`"),
    (["find", "mine.toml", "a.csv"], "'a.csv' is not expected; to follow a record: `stickslip infer mine.toml a.csv --free NAMES`"),
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


scenario = cache(ss.load_scenario)


@cache
def every_name() -> set[str]:
    """Return, in their plain form, the names that the package has at its doors."""
    from stickslip.cli.app import _built
    from stickslip.extensions.inference.fit.free import known_numbers
    from stickslip.extensions.inference.fit.setup import SENSORS
    from stickslip.extensions.sweeps.design.quantities import QUANTITIES as OF_SWEEPS
    from stickslip.figures.sheet import KEYWORDS
    from stickslip.foundation.headings import KNOWN_COLUMNS
    from stickslip.foundation.names import QUANTITIES
    from stickslip.problem.bodies import BODIES
    from stickslip.problem.loading import HISTORIES
    from stickslip.problem.scenarios.schema import TABLES, keys_of
    from stickslip.problem.selection_rule import SELECTION_RULES
    from stickslip.run.find import WHAT
    from stickslip.run.kinds import special_solvers

    registered = (
        BODIES,
        ss.friction.LAWS,
        HISTORIES,
        WHAT,
        OF_SWEEPS,
        QUANTITIES,
        KNOWN_COLUMNS,
        SELECTION_RULES,
        KEYWORDS,
        SENSORS,
        TABLES,
        ("contact",),
    )
    found = {name for table in registered for name in table} | set(COMMANDS) | set(library.STARTERS) | set(library.names())
    kinds = [*BODIES.values(), *ss.friction.LAWS.values(), *HISTORIES.values()]
    found |= {key for table in TABLES for kind in kinds for key in keys_of(table, kind)}
    found |= {option for command in COMMANDS for one in _built(command).params for option in one.opts}
    found |= {name for module in (ss, ss.friction, ss.studies, ss.loading) for name in module.__all__}
    found |= set(known_numbers(scenario("rate-and-state-block").problem, {})) | {
        one.name for one in parameter_paths(scenario("fig6-slab"))
    }
    found |= {*dir(run()), *run().events.columns, *dir(scenario("fig6-slab").problem), *dir(ss.studies.compare(run(), run()))}
    for call in (ss.simulate, ss.catalogue, ss.sweep, ss.studies.infer, ss.friction.fit):
        found |= set(inspect.signature(call).parameters)
    found |= {option for solver in special_solvers() for option in solver.takes}
    return {plain(name) for name in found}


def test_each_name_that_a_word_leads_to_is_one_of_ours_and_each_word_is_none_of_its_own() -> None:
    ours = every_name()
    assert [name for name, _ in rows() if ours.isdisjoint({plain(name), plain(last(name))})] == []
    assert [(name, word) for name, words in rows() for word in words if plain(name) == plain(word)] == []
