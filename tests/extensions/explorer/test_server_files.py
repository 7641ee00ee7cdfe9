"""What a page gives away and takes in: files that run with the same numbers, untrusted uploads, and links."""

from __future__ import annotations

import base64
import io
import re
from pathlib import Path
from urllib.parse import parse_qsl

import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.answer import Answer
from stickslip.extensions.explorer.model.exchange import with_kind
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.model.strip import strip_range
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.extensions.explorer.page.files import FORMATS, content_of, export, file_name, opened, plain_name
from stickslip.extensions.explorer.page.tools import Tools, begin, query_of
from stickslip.extensions.explorer.page.words import PinnedRun, words_of
from stickslip.foundation.errors import InputError
from tests.extensions.explorer.desk_at_once import DeskAtOnce
from tests.messages import refused

SETTING = Setting.bundled("fig6-slab").with_value("friction.alpha", 0.7)


@pytest.fixture(scope="module")
def answer() -> Answer:
    return solve(SETTING.scenario())


@pytest.fixture
def explorer(answer: Answer) -> Explorer:
    """A page whose every answer is the same, which links and buttons do not mind."""
    made = Explorer(SETTING, DeskAtOnce(), lambda scenario, told: answer)
    made.change(SETTING)
    return made


# ---- files to save


def test_the_saved_scenario_runs_with_the_same_numbers(answer: Answer, tmp_path: Path) -> None:
    name, _, content = export("toml", SETTING, answer)
    (tmp_path / name).write_bytes(content)
    assert content.decode().startswith(f"# Made in the explorer of stickslip {ss.__version__}; run it with: stickslip run {name}\n")
    pd.testing.assert_frame_equal(ss.simulate(tmp_path / name).events, answer.solution.events, check_exact=True)


def test_the_saved_run_is_the_one_that_is_shown(answer: Answer, tmp_path: Path) -> None:
    (tmp_path / "run.nc").write_bytes(export("netcdf", SETTING, answer)[2])
    saved = ss.open_solution(tmp_path / "run.nc")
    pd.testing.assert_frame_equal(saved.events, answer.solution.events, check_exact=True)


def test_saved_tables_hold_all_digits_and_where_they_come_from(answer: Answer) -> None:
    events = export("events", SETTING, answer)[2]
    read = pd.read_csv(io.BytesIO(events), comment="#")
    pd.testing.assert_frame_equal(read, answer.solution.events, check_exact=True, check_dtype=False)
    curves = pd.read_csv(io.BytesIO(export("curves", SETTING, answer)[2]), comment="#")
    own = curves[curves.body == answer.motions[0].name]
    assert (own.slip_rate.to_numpy() == answer.motions[0].slip_rate).all()
    assert b"# alpha = 0.7\n" in events


@pytest.mark.slow
def test_saved_figures_are_those_of_the_command_line(answer: Answer, tmp_path: Path) -> None:
    from stickslip.cli.output.files import FigureLook, drawing

    by_command = drawing(answer.solution.plot, FigureLook())(tmp_path / "by-command.svg")
    by_page = tmp_path / "by-page.svg"
    by_page.write_bytes(export("svg", SETTING, answer)[2])
    drawn = [re.findall(r' d="([^"]*)"', path.read_text()) for path in (by_command, by_page)]
    assert drawn[0] == drawn[1] != []


def test_an_unknown_kind_of_file_is_one_line(answer: Answer) -> None:
    with pytest.raises(InputError, match=r"^export: there is no kind '\.\./x'; allowed: toml, "):
        export("../x", SETTING, answer)


@pytest.mark.parametrize(
    ("name", "expected"),
    [("fig6-slab", "fig6-slab-changed.nc"), ("../../etc/passwd", "etc-passwd.nc"), ("a b/ä\n", "a-b.nc"), ("..", "scenario.nc")],
)
def test_names_of_files_are_plain(name: str, expected: str) -> None:
    assert file_name(Setting(name, SETTING.document), ".nc") == expected


def test_a_file_that_was_asked_for_reaches_the_browser(explorer: Explorer, monkeypatch: pytest.MonkeyPatch) -> None:
    tools, sent = Tools(explorer), []
    monkeypatch.setattr(tools.view, "_send_msg", sent.append)
    tools.view._handle_msg({"do": "save", "kind": "toml"})
    assert [(one["save"], one["media"]) for one in sent] == [("fig6-slab-changed.toml", "application/toml")]
    assert not tools.view.busy
    tools.view._handle_msg({"do": "save", "kind": "exe"})
    assert explorer.fault.startswith("export: there is no kind 'exe'")
    for nonsense in (None, [], {"do": 3}, {"do": "open"}, {"do": "save"}):
        tools.view._handle_msg(nonsense)
    assert set(FORMATS) == {one["kind"] for one in tools.view.kinds}


# ---- files to open


def test_an_opened_scenario_is_shown() -> None:
    text = ss.scenarios["fig6-block-printed"].to_toml()
    setting = opened("C:\\users\\me\\mine.toml", text.encode(), SETTING)
    assert (setting.name, setting.scenario().problem) == ("mine", ss.scenarios["fig6-block-printed"].problem)


@pytest.mark.parametrize(("heading", "key"), [("slip (mm)", "slip"), ("v (m/s)", "rate")])
def test_an_opened_table_becomes_the_friction_law(heading: str, key: str) -> None:
    setting = opened("points.csv", f"{heading},mu\n0,0.8\n100,0.5\n300,0.4\n".encode(), SETTING)
    assert setting.document["friction"]["kind"] == "table"
    assert setting.document["friction"][key] == ([0.0, 0.1, 0.3] if key == "slip" else [0.0, 100.0, 300.0])
    assert setting.scenario().problem.body == SETTING.scenario().problem.body


def test_doubts_about_an_opened_table_are_notes_of_the_answer_until_another_law_is_chosen() -> None:
    """A column without a unit, and friction in percent; that they are warnings of the package would fail here."""
    here = Explorer(SETTING, DeskAtOnce(), solve)
    here.change(opened("points.csv", b"slip,mu\n0,80\n1000,50\n", SETTING))
    doubts = ("points.csv, line 1: column 1, slip, has no unit and is read in m", "friction reaches 80")
    assert here.answer is not None
    assert [sum(doubt in note for note in here.answer.notes) for doubt in doubts] == [1, 1]
    assert set(here.answer.notes) == set(words_of(here.answer)["notes"])
    here.change(here.setting.with_value("run.duration", 1.0))
    assert [sum(doubt in note for note in here.answer.notes) for doubt in doubts] == [1, 1]
    here.change(with_kind(here.setting, "friction", "hyperbolic-rate"))
    assert [sum(doubt in note for note in here.answer.notes) for doubt in doubts] == [0, 0]


def test_noisy_points_are_noted_once() -> None:
    rows = "".join(f"{k},{0.8 - 0.01 * k + 0.05 * (-1) ** k}\n" for k in range(30))
    here = Explorer(SETTING, DeskAtOnce(), solve)
    here.change(opened("points.csv", f"slip (m),mu\n{rows}".encode(), SETTING))
    assert here.answer is not None
    assert sum("noisy" in note for note in here.answer.notes) == 1


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.toml", b"[body\n", "a.toml: line 1: '[body' is not TOML"),
        ("../../secret.toml", b"[body]", "secret.toml: "),
        ("a.toml", b"#" * 1_000_001, "a.toml: larger than 1000000 bytes"),
        ("a.csv", b"\xff\xfe\x00", "a.csv: not a text file"),
        ("a\n\x1b[31m.csv", b"", "a[31m.csv: is empty"),
        ("../../a.csv", b"slip,mu\n0,0.8\n", "a.csv: at least two points"),
        ("a.csv", b"slip (m),mu\n" + b"".join(b"%d,0.5\n" % k for k in range(20_001)), "a.csv: has 20001 points, at most 20000"),
    ],
)
def test_an_upload_that_cannot_be_used_is_one_line(name: str, content: bytes, message: str) -> None:
    with refused(begins=message):
        opened(name, content, SETTING)


def test_an_opened_scenario_cannot_name_files_of_this_computer(tmp_path: Path) -> None:
    table = tmp_path / "secret.csv"
    table.write_text("slip,mu\n0,0.8\n1,0.5\n")
    text = ss.scenarios["fig6-slab"].to_toml().partition("[friction]")
    text_with_file = f'{text[0]}[friction]\nkind = "table"\nfile = "{table}"\n{text[2][text[2].index("[loading]") :]}'
    with pytest.raises(InputError, match=r"^mine\.toml"):
        opened("mine.toml", text_with_file.encode(), SETTING)


def test_a_bad_upload_leaves_the_last_good_picture(explorer: Explorer) -> None:
    tools, setting, shown = Tools(explorer), explorer.setting, explorer.shown
    tools.view._handle_msg({"do": "open", "name": "a.toml", "content": base64.b64encode(b"x = 1").decode()})
    assert explorer.fault.startswith("a.toml: ")
    tools.view._handle_msg({"do": "open", "name": "a.toml", "content": "%%%"})
    assert explorer.fault == "the file did not arrive whole: open it again"
    assert (explorer.setting, explorer.shown) == (setting, shown)
    with pytest.raises(InputError, match="larger than 1000000 bytes"):
        content_of("A" * 1_400_000)


def test_names_of_uploads_lose_their_folders() -> None:
    assert [plain_name(one) for one in ("a/b.toml", "c:\\b.toml", "", "\u202eb.toml", "x" * 500)] == [
        "b.toml",
        "b.toml",
        "file",
        "b.toml",
        "x" * 80,
    ]


# ---- pin, and links


def test_a_pinned_run_is_compared_by_name(explorer: Explorer) -> None:
    view = PinnedRun(explorer).view
    explorer.pin()
    assert view.visible
    assert "Nothing is changed yet" in view.object
    explorer.change(SETTING.with_value("friction.alpha", 0.9).with_value("title", "<script>"))
    assert "<li>friction.alpha: 0.7 → 0.9</li>" in view.object
    assert "<script>" not in view.object
    explorer.pin()
    assert (view.visible, view.object) == (False, "")


def test_a_link_reproduces_the_view(explorer: Explorer, answer: Answer) -> None:
    explorer.pin()
    explorer.change(SETTING.with_value("friction.alpha", 0.9), 2.5)
    explorer.show_step(3, None, None, 0.0)
    explorer.show_strip(strip_range("friction.alpha", 0.1, 2.0, log=True))
    query = query_of(explorer)
    assert "scenario=fig6-slab&friction.alpha=0.9&" in query

    other = Explorer(Setting.bundled("fig4-loop"), DeskAtOnce(), lambda scenario, told: answer)
    asked: list[float] = []
    other.listen("setting", lambda: asked.append(other.setting.value("friction.alpha")))
    begin(other, dict(parse_qsl(query)))
    other_query = query_of(other)
    assert other_query == query
    assert asked[-1] == 0.9
    assert other.pinned is not None
    assert (other.pinned[0].document, other.setting.document) == (SETTING.document, explorer.setting.document)
    assert (other.cursor, other.tour, other.strip) == (2.5, 3, explorer.strip)
    assert other.fault == ""


@pytest.mark.parametrize(
    ("parameters", "fault"),
    [
        ({"scenario": "fig6-slap"}, "did you mean 'fig6-slab'?"),
        ({"scenario": "fig6-slab", "friction.alpha": "-1"}, "alpha"),
        ({"scenario": "fig6-slab", "document": "xxx"}, "link: the document in it is broken"),
        ({"scenario": "fig6-slab", "pin": "&".join("a=1" for _ in range(600))}, "fields"),
        ({"t": "nan", "tour": "99", "strip": "a:b:c"}, ""),
        ({"tour": "-1", "strip": "os.path:1", "t": "9" * 400}, ""),
    ],
)
def test_a_link_that_cannot_be_followed_shows_the_first_scenario_and_says_why(
    parameters: dict[str, str], fault: str, answer: Answer
) -> None:
    explorer = Explorer(SETTING, DeskAtOnce(), lambda scenario, told: answer)
    begin(explorer, parameters)
    assert explorer.answer is answer
    assert fault in explorer.fault
    assert bool(fault) == bool(explorer.fault)
    assert (explorer.tour, explorer.strip, explorer.pinned) == (0, None, None)
    assert fault == "" or explorer.setting == SETTING or "fields" in fault


def test_the_address_follows_the_page_once_the_first_answer_is_there(answer: Answer) -> None:
    explorer = Explorer(SETTING, DeskAtOnce(), lambda scenario, told: answer)
    tools = Tools(explorer)
    assert tools.view.query == ""
    explorer.change(SETTING)
    assert tools.view.query == "scenario=fig6-slab&friction.alpha=0.7&v=1"
    assert Tools(explorer, linked=False).view.query == ""
