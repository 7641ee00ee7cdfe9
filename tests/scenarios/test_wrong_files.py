"""What is given in place of a scenario file, and slips of the pen in one, are told in one line with the cure."""

import os
import tomllib
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.foundation.errors import InputError
from stickslip.scenarios import library
from stickslip.scenarios.scenario import load_scenario

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


CURES = [
    ("alpha = 1,5", "alpha = 1.5, with a decimal point"),
    ("alpha = -1_000,5  # s/m", "alpha = -1_000.5, with a decimal point"),
    ("alpha = 1,5e3", "alpha = 1.5e3, with a decimal point"),
    ("alpha = 1,5 s/m", 'alpha = "1.5 s/m", with a decimal point'),
    ("alpha = .5", "alpha = 0.5, with a digit before the point"),
    ("alpha = -.5e3", "alpha = -0.5e3, with a digit before the point"),
    ("alpha = 5.", "alpha = 5.0, with a digit after the point"),
    ("alpha = 5.e3", "alpha = 5.0e3, with a digit after the point"),
    ("alpha = 1 000.5", "alpha = 1000.5, without gaps"),
    ("alpha = 1'000", "alpha = 1000, without gaps"),
    ("alpha = 05", "alpha = 5, without the first 0"),
    ("alpha = 1 s/m", 'alpha = "1 s/m", in quotes'),
    ("alpha = 1s/m", 'alpha = "1s/m", in quotes'),
    ("alpha = word", 'alpha = "word", in quotes'),
    ('alpha = "1 s/m', 'alpha = "1 s/m", with both quotes'),
    ("alpha = \u201c1 s/m\u201d", 'alpha = "1 s/m", with straight quotes'),
    ("alpha = True", "alpha = true, in small letters"),
    ("alpha = 1;", "alpha = 1, and no other sign"),
    ("alpha == 1", "alpha = 1, and no other sign"),
    ("alpha = 10^3", "alpha = the number itself, as 1e3: nothing is calculated"),
    ("alpha : 1", "alpha = 1"),
    ("alpha 1", "KEY = VALUE, or # before a comment"),
    ("[friction", "[friction]"),
]


@pytest.mark.parametrize(("line", "cure"), CURES)
def test_a_slip_of_the_pen_is_told_with_its_line_and_its_cure(tmp_path: Path, line: str, cure: str):
    file = tmp_path / "mine.toml"
    text = GOOD.replace("[friction]", line) if line.startswith("[") else GOOD.replace(ALPHA, line)
    file.write_text(text, encoding="utf-8")
    place = LINE if not line.startswith("[") else GOOD.splitlines().index("[friction]") + 1
    message = refusal(file)
    assert message.startswith(f"line {place}: ")
    assert message.endswith(f" is not TOML: write {cure}")


@pytest.mark.parametrize("cure", [cure for _, cure in CURES if cure.startswith("alpha = ") and "number itself" not in cure])
def test_the_cure_is_toml(cure: str):
    assert "alpha" in tomllib.loads(cure.rpartition(", ")[0] or cure)


UNSAFE = ["alpha = 1,5\x1b[31m", f"alpha = {'1' * 900_000}x", f"[{'a ' * 400_000}", f"alpha = {'1+' * 90_000}"]


@pytest.mark.parametrize("line", UNSAFE, ids=["escape", "digits", "heading", "sum"])
def test_a_line_that_is_not_safe_to_show_is_cut_and_quoted(tmp_path: Path, line: str):
    file = tmp_path / "mine.toml"
    file.write_text(GOOD.replace(ALPHA, line))
    message = refusal(file)
    assert message.isprintable()
    assert message.startswith("not TOML: ")
    assert len(message) < 200


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("alpha =", "line {n}: 'alpha =' is not TOML: alpha has no value"),
        ("alpha = 1\nalpha = 2", "line {m}: 'alpha = 2' is not TOML: 'alpha' is given twice"),
        ("alpha = [1, 2", "line {k}: '[loading]' is not TOML: a bracket or a quotation mark before it is not closed"),
        ('alpha = "1,5 s/m"', "got '1,5 s/m': write '1.5 s/m', with a decimal point"),
        ('alpha = "1,5"', "got '1,5': write '1.5', with a decimal point"),
    ],
)
def test_other_slips_are_told(tmp_path: Path, line: str, message: str):
    file = tmp_path / "mine.toml"
    file.write_text(GOOD.replace(ALPHA, line))
    heading = GOOD.splitlines().index("[loading]") + 1
    assert refusal(file).endswith(message.format(n=LINE, m=LINE + 1, k=heading))


def test_a_folder_tells_its_scenarios(tmp_path: Path):
    assert refusal(tmp_path) == "is a folder, not a scenario; it holds no TOML file"
    for name in ("a.toml", "b.toml"):
        (tmp_path / name).touch()
    assert refusal(tmp_path) == "is a folder, not a scenario; its scenarios: a.toml, b.toml"


def test_results_are_told_from_scenarios(tmp_path: Path):
    run, sweep, table = tmp_path / "run.nc", tmp_path / "map.zarr", tmp_path / "points.csv"
    ss.simulate("fig6-slab").to_netcdf(run)
    assert refusal(run).startswith("a file of results, not a scenario: `stickslip show` summarises it, and")
    renamed = run.rename(tmp_path / "run.toml")
    assert refusal(renamed).startswith("a file of results, not a scenario")
    ss.sweep("fig6-slab", {"friction.alpha": np.array([0.5, 1.0])}, out=sweep)
    assert refusal(sweep) == f"a folder of results, not a scenario: `stickslip show {sweep}` summarises them"
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
