"""What is given in place of a scenario file, and slips of the pen in one, are told in one line."""

import os
import tomllib
from pathlib import Path

import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.scenario import load_scenario

GOOD = library.text("fig6-slab")
ALPHA = next(line for line in GOOD.splitlines() if line.startswith("alpha"))
LINE = GOOD.splitlines().index(ALPHA) + 1


def refusal(path: Path) -> str:
    """The message, without the name of the file, with which a file is refused."""
    with pytest.raises(InputError) as refused:
        load_scenario(path)
    message = str(refused.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    return message.removeprefix(f"{path}: ")


FORM = 'write a number as 1.5 or 1e3, and a word or a number with a unit in quotes, as "1.5 s/m"'
SLIPS = [
    ("alpha = 1,5", FORM),
    ("alpha = .5", FORM),
    ("alpha = 1 s/m", FORM),
    ("alpha = word", FORM),
    ('alpha = "1 s/m', FORM),
    ("alpha = \u201c1 s/m\u201d", FORM),
    ("alpha =", "Invalid value"),
    ("alpha : 1", "Expected '=' after a key in a key/value pair"),
    ("[friction", "Expected ']' at the end of a table declaration"),
]


@pytest.mark.parametrize(("line", "why"), SLIPS)
def test_a_slip_of_the_pen_is_told_with_its_line(tmp_path: Path, line: str, why: str):
    file = tmp_path / "mine.toml"
    text = GOOD.replace("[friction]", line) if line.startswith("[") else GOOD.replace(ALPHA, line)
    file.write_text(text, encoding="utf-8")
    place = LINE if not line.startswith("[") else GOOD.splitlines().index("[friction]") + 1
    assert refusal(file) == f"line {place}: {line!a} is not TOML: {why}"


def test_values_as_the_message_writes_them_are_toml():
    assert tomllib.loads('a = 1.5\nb = 1e3\nc = "1.5 s/m"')


UNSAFE = ["alpha = 1,5\x1b[31m", f"alpha = {'1' * 900_000}x", f"[{'a ' * 400_000}", f"alpha = {'1+' * 90_000}"]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("line", UNSAFE, ids=["escape", "digits", "heading", "sum"])
def test_a_line_that_is_not_safe_to_show_is_cut_and_quoted(tmp_path: Path, line: str):
    file = tmp_path / "mine.toml"
    file.write_text(GOOD.replace(ALPHA, line))
    message = refusal(file)
    assert message.isprintable()
    assert "not TOML: " in message
    assert len(message) < 200


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("alpha = 1\nalpha = 2", "line {m}: 'alpha = 2' is not TOML: Cannot overwrite a value"),
        ("alpha = [1, 2", "line {k}: '[loading]' is not TOML: Unclosed array"),
        ('alpha = "1,5 s/m"', "got '1,5 s/m': write '1.5 s/m', with a decimal point"),
        ('alpha = "1,5"', "got '1,5': write '1.5', with a decimal point"),
    ],
)
def test_other_slips_are_told(tmp_path: Path, line: str, message: str):
    file = tmp_path / "mine.toml"
    file.write_text(GOOD.replace(ALPHA, line))
    heading = GOOD.splitlines().index("[loading]") + 1
    assert refusal(file).endswith(message.format(m=LINE + 1, k=heading))


def test_a_folder_tells_its_scenarios(tmp_path: Path):
    assert refusal(tmp_path) == "is a folder, not a scenario; it holds no TOML file"
    for name in ("a.toml", "b.toml"):
        (tmp_path / name).touch()
    assert refusal(tmp_path) == "is a folder, not a scenario; its scenarios: a.toml, b.toml"


def test_results_are_told_from_scenarios(tmp_path: Path):
    run, table = tmp_path / "run.nc", tmp_path / "points.csv"
    ss.simulate("fig6-slab").to_netcdf(run)
    assert refusal(run).startswith("a file of results, not a scenario: `stickslip show` summarises it, and")
    renamed = run.rename(tmp_path / "run.toml")
    assert refusal(renamed).startswith("a file of results, not a scenario")
    table.write_text("slip,friction\n0,0.8\n")
    assert refusal(table).startswith("a table, not a scenario: a scenario names it, as [friction] file")
    picture = tmp_path / "a.png"
    Figure().savefig(picture)
    assert refusal(picture) == "a picture, not a scenario"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "is empty; `stickslip new slab > mine.toml` writes a scenario to start from"),
        (b"\xef\xbb\xbf  \n", "is empty; `stickslip new slab > mine.toml` writes a scenario to start from"),
        (b"\x7fELF\x02\x00\xff\xfe\x80", "not a text file, so not a scenario; `stickslip new slab > mine.toml` writes"),
        (b"[body]\x00", "not a text file, so not a scenario; `stickslip new slab > mine.toml` writes"),
        ("[body]\n# é\n".encode("latin-1"), "not a text file in UTF-8: line 2 has other letters; save it as UTF-8"),
    ],
)
def test_a_file_without_readable_text_is_told(tmp_path: Path, content: bytes, message: str):
    file = tmp_path / "mine.toml"
    file.write_bytes(content)
    assert refusal(file).startswith(message)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le"])
def test_text_with_a_byte_order_mark_is_read(tmp_path: Path, encoding: str):
    """Some shells redirect text as UTF-16, with such a mark before it."""
    file = tmp_path / "mine.toml"
    file.write_bytes((b"\xff\xfe" if encoding == "utf-16-le" else b"") + GOOD.encode(encoding))
    assert load_scenario(file) == load_scenario("fig6-slab")


def test_a_pipe_points_to_standard_input(tmp_path: Path):
    os.mkfifo(tmp_path / "pipe")
    assert refusal(tmp_path / "pipe").endswith("not a scenario; the name - stands for standard input")
