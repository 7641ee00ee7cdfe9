"""What newcomers of seven trades type by mistake: each is refused in one line with the cure, or understood (`clumsy.toml`)."""

from __future__ import annotations

import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from stickslip.cli.main import main
from stickslip.cli.overrides import load
from stickslip.foundation.given import shown_in
from stickslip.problem.scenarios.templates import template

TABLE: dict[str, Any] = tomllib.loads(Path(__file__).with_name("clumsy.toml").read_text(encoding="utf-8"))
OF_EXTENSIONS = sorted(Path(__file__).parents[2].glob("extensions/*/clumsy.toml"))
"""What is typed of the extensions whose tests are there."""
GROUPS = [group for name, group in TABLE.items() if name != "si"]
GROUPS += [group for path in OF_EXTENSIONS for group in tomllib.loads(path.read_text(encoding="utf-8")).values()]
REFUSED: dict[str, str] = {typed: wanted for group in GROUPS for typed, wanted in group.get("refused", {}).items()}
ANSWERED: dict[str, str] = {typed: wanted for group in GROUPS for typed, wanted in group.get("answered", {}).items()}
MOST_NAMES = 8
"""A line of error lists at most this many names."""
LIST = re.compile(rf"(?:[\w.'<>-]+, ){{{MOST_NAMES},}}[\w.'<>-]+")
SLAB = template("slab")
SPELT_BADLY = {
    "typo": SLAB.replace("thickness =", "thicknes ="),
    "table": SLAB.replace("[friction]", "[fricton]"),
    "comma": SLAB.replace('"10 km"', '"10,5 km"'),
    "bare": SLAB.replace('"10 km"', "10 km"),
    "mass": SLAB.replace('"10 km"', '"10 kg"'),
    "negative": SLAB.replace('"10 km"', '"-10 km"'),
    "zero": SLAB.replace('"10 km"', "0"),
    "plate": SLAB.replace('kind = "elastic-slab"', 'kind = "plate"'),
    "twice": f"{SLAB}\n[body]\nthickness = 1\n",
    "law-alone": '[friction]\nkind = "coulomb"\nstatic = 0.6\ndynamic = 0.5\n',
    "open-quote": SLAB.replace('"10 km"', '"10 km'),
    "quoted": SLAB.replace("static = 0.8", 'static = "0.8"'),
}
RATES = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0]
TABLES = {
    "record": "time (s),friction,load_point (mm)\n" + "".join(f"{i},{0.6 + 0.001 * (i % 3)},{0.01 * i:.3f}\n" for i in range(60)),
    "points": "v (mm/s),mu\n" + "".join(f"{v},{0.3 + 0.3 / (1 + v):.4f}\n" for v in RATES),
    "comma": "v (mm/s);mu\n" + "".join(f"{v},000;1,{600 - v}\n" for v in range(1, 7)),
    "shop": "Sliding velocity [ft/min]\tCOF\n" + "".join(f"{v}\t{0.3 + 0.3 / (1 + v):.4f}\n" for v in RATES),
    "empty": "",
    "headings": "time (s),friction,load_point (mm)\n",
    "temperature": "time (s),temperature (K)\n0,300\n1,301\n2,302\n",
    "kilometres": "time (km),friction,load_point (mm)\n0,0.6,0\n1,0.61,0.01\n2,0.62,0.02\n",
}
OTHERS = {
    "notes.pdf": b"%PDF-1.4 notes",
    "binary.nc": bytes(range(256)) * 4,
    "data.mat": b"MATLAB 5.0 MAT-file, Platform: GLNXA64".ljust(128) + bytes(64),
    "log.las.xlsx": b"PK\x03\x04" + bytes(200),
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files that newcomers name."""
    place = tmp_path_factory.mktemp("clumsy")
    for name, text in SPELT_BADLY.items():
        (place / f"{name}.toml").write_text(text, encoding="utf-8")
    for name, text in TABLES.items():
        (place / f"{name}.csv").write_text(text, encoding="utf-8")
    for name, content in OTHERS.items():
        (place / name).write_bytes(content)
    return place


@pytest.fixture
def inside(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Work in that folder, and find it as it was left."""
    monkeypatch.chdir(folder)
    before = sorted(folder.iterdir())
    yield folder
    assert sorted(folder.iterdir()) == before


def stand_in_order(wanted: str, text: str) -> bool:
    """Return True if the parts of a wanted text, between its " ... ", stand in a text in this order."""
    place = 0
    for part in wanted.split(" ... "):
        found = text.find(part, place)
        if found < 0:
            return False
        place = found + len(part)
    return True


@pytest.mark.sampled(every=5)
@pytest.mark.usefixtures("inside")
@pytest.mark.parametrize("typed", REFUSED)
def test_a_mistake_is_refused_in_one_line_with_the_cure(typed: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(shlex.split(typed))
    shown = capsys.readouterr()
    assert (ended.value.code, shown.out, shown.err.count("\n")) == (2, "", 1), shown
    assert shown.err.startswith("stickslip: ")
    assert stand_in_order(REFUSED[typed], shown.err), shown.err
    assert not LIST.search(shown.err), shown.err
    assert len(shown.err) < 420, shown.err


@pytest.mark.sampled(every=4)
@pytest.mark.usefixtures("inside")
@pytest.mark.parametrize("typed", ANSWERED)
def test_what_can_be_understood_is_answered(typed: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(shlex.split(typed))
    shown = capsys.readouterr()
    assert ended.value.code in (0, None), shown.err
    assert stand_in_order(ANSWERED[typed], shown.out), shown.out


@pytest.mark.parametrize("typed", TABLE["si"])
def test_units_of_the_trades_are_read(typed: str) -> None:
    scenario, _, change = typed.partition(" ")
    with shown_in({}):  # units that a command shows end with it
        problem = load(scenario, "check", [change]).problem
    assert problem.parameters[change.partition("=")[0]].value == pytest.approx(TABLE["si"][typed], rel=1e-12)
