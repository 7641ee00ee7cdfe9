"""The measures of the house find what they look for, in small packages that are made for it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from benchmarks.house import House
from benchmarks.rooms import Bounds, lowered, report

Make = Callable[[dict[str, str]], House]
FILES = {
    "__init__.py": "",
    "extension.py": "class Extension: ...\n",
    "foundation/__init__.py": "",
    "foundation/units.py": "YEAR = 1.0\nDAY = 2.0\n",
    "engine/__init__.py": "",
    "engine/loop.py": "from stickslip.foundation.units import YEAR\n",
    "run/__init__.py": "",
    "run/simulate.py": "from stickslip.engine import loop\nfrom stickslip.foundation.units import DAY, YEAR\n",
    "extensions/__init__.py": "",
    "extensions/planar/__init__.py": "from stickslip.extension import Extension\n",
    "extensions/planar/solver.py": "from stickslip.foundation.units import YEAR\n",
    "extensions/paper/__init__.py": "from stickslip.extension import Extension\n",
}
"""A sound package."""
BOUNDS = """[most]
"lines of the core" = 5
"names that cross rooms" = 4
"files entered from outside" = 3
"functions that ask a kind" = 0
"conditions that ask a kind" = 0
"imports of extensions by the core" = 0
"imports between extensions" = 0
"""


@pytest.fixture
def make(tmp_path: Path) -> Make:
    """Return a function that makes the package with some files as they are given."""

    def made(files: dict[str, str]) -> House:
        package = tmp_path / str(len(list(tmp_path.iterdir()))) / "stickslip"
        for name, text in (FILES | files).items():
            path = package / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        return House(package)

    return made


def test_a_sound_house_keeps_its_bounds_and_its_numbers_are_those_counted_by_hand(make: Make) -> None:
    house = make({})
    assert Bounds.read(BOUNDS).broken(house) == []
    assert list(house.numbers().values()) == [5, 4, 3, 0, 0]  # YEAR, DAY, loop and Extension, of three files
    assert house.lists() == {"up": set(), "of_extensions": set(), "between_extensions": set()}
    assert "foundation       2      2            2        1  " in list(report(house))


@pytest.mark.parametrize(
    ("text", "when"),
    [
        ("from stickslip.run.simulate import it", "eager"),
        ("import stickslip.run.simulate", "eager"),
        ("from stickslip.run import simulate", "eager"),
        ("from ..run.simulate import it", "eager"),
        ("from ..run import simulate", "eager"),
        ("def f():\n    from stickslip.run.simulate import it", "later"),
        ("class A:\n    def f(self):\n        if self:\n            import stickslip.run.simulate", "later"),
        ("from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from stickslip.run.simulate import it", "types"),
        ("import typing\nif typing.TYPE_CHECKING:\n    from stickslip.run.simulate import it", "eager"),
        ("try:\n    import stickslip.run.simulate\nexcept ImportError:\n    pass", "eager"),
    ],
)
def test_an_import_that_runs_up_is_found_in_every_form(make: Make, text: str, when: str) -> None:
    house = make({"engine/loop.py": text})
    edge = f"engine/loop.py -> run, {when}"
    assert house.lists()["up"] == {edge}
    assert f"up: {edge} is new" in Bounds.read(BOUNDS).broken(house)


@pytest.mark.parametrize("file", ["run/simulate.py", "extension.py", "studies/__init__.py"])
def test_an_import_of_an_extension_by_the_core_is_found(make: Make, file: str) -> None:
    house = make({file: "def f():\n    from stickslip.extensions.planar.solver import solve"})
    assert house.lists()["of_extensions"] == {f"{file} -> planar, later"}
    assert house.numbers()["imports of extensions by the core"] == 1


def test_an_extension_that_takes_from_another_one_is_found_unless_it_declares_it(make: Make) -> None:
    taken = "import stickslip.extensions.planar.solver\n"
    house = make({"extensions/paper/report.py": taken})
    assert house.lists()["between_extensions"] == {"extensions/paper/report.py -> planar, eager"}
    needs = "class Paper:\n    needs: ClassVar[tuple[str, ...]] = ("
    declared = {"extensions/paper/report.py": taken, "extensions/paper/__init__.py": f'{needs}"planar",)'}
    assert make(declared).lists()["between_extensions"] == set()
    other = make(declared | {"extensions/paper/__init__.py": f'{needs}"sweeps",)'})
    assert len(other.lists()["between_extensions"]) == 1


@pytest.mark.parametrize(
    ("code", "is_fine"),
    [
        ("def f():\n    from stickslip.extensions.planar import solve", True),
        ("from stickslip.extensions.planar import solve", False),
        ("def f():\n    from stickslip.extensions.planar.solver import solve", False),
        ("def f():\n    from stickslip.extensions.sweeps import sweep", False),
    ],
)
def test_what_an_extension_only_uses_it_imports_from_the_front_and_when_it_is_used(make: Make, code: str, is_fine: bool) -> None:
    uses = {"extensions/paper/__init__.py": 'class Paper:\n    uses = ("planar",)', "extensions/sweeps/__init__.py": ""}
    house = make(uses | {"extensions/planar/__init__.py": "", "extensions/paper/report.py": code})
    assert (house.lists()["between_extensions"] == set()) is is_fine


def test_the_name_of_an_extension_in_a_text_is_found_and_in_a_docstring_is_none(make: Make) -> None:
    assert make({"run/simulate.py": '"""As stickslip.extensions.planar does."""'}).named_extensions() == []
    assert make({"run/simulate.py": 'HOME = "stickslip.extensions.planar"'}).named_extensions() == [
        "run/simulate.py:1: extensions.planar"
    ]
    assert len(make({"run/simulate.py": 'f = lambda: load("extensions/planar")'}).named_extensions()) == 1


@pytest.mark.parametrize(
    "text", ["import stickslip as ss\nss.sweep()", "import stickslip\nstickslip.sweep()", "from stickslip import sweep"]
)
def test_what_the_core_takes_from_the_public_names_is_found(make: Make, text: str) -> None:
    assert make({"run/simulate.py": text}).taken_from_the_top() == {("run/simulate.py", "sweep")}
    assert make({"run/simulate.py": "import stickslip.engine.loop\nstickslip.engine.loop.run()"}).taken_from_the_top() == set()


def test_a_circle_within_a_room_is_found_at_every_depth(make: Make) -> None:
    inside = {
        "engine/waves/echo.py": "import stickslip.engine.waves.load",
        "engine/waves/load.py": "import stickslip.engine.waves.echo",
    }
    assert set(make(inside).circles()) == {"engine/waves"}
    folders = {
        "engine/waves/echo.py": "import stickslip.engine.loop",
        "engine/waves/load.py": "",
        "engine/loop.py": "import stickslip.engine.waves.load",
    }
    assert set(make(folders).circles()) == {"engine"}


def test_a_door_may_close_a_circle_inside_a_function_only_and_only_while_it_does(make: Make) -> None:
    bounds = Bounds.read(BOUNDS + '\n[[doors]]\nreason = "it draws itself"\nfiles = [\n    "engine/loop.py",\n]\n')
    back = "import stickslip.engine.loop"
    later = make({"engine/loop.py": "def f():\n    import stickslip.engine.draw", "engine/draw.py": back})
    assert [line for line in bounds.broken(later) if "circle" in line or "doors" in line] == []
    assert any(
        "circle" in line for line in bounds.broken(make({"engine/loop.py": "import stickslip.engine.draw", "engine/draw.py": back}))
    )
    assert any("engine/loop.py is gone" in line for line in bounds.broken(make({"engine/loop.py": "", "engine/draw.py": back})))


def test_numbers_may_fall_a_little_and_never_rise(make: Make) -> None:
    house, name = make({}), "lines of the core"
    most = dict(Bounds.read(BOUNDS).most)
    assert Bounds(most | {name: 4}, {}).broken(house) == [f"{name}: 5, and 4 are allowed"]
    assert Bounds(most | {name: 5}, {}).broken(house) == []
    assert len(Bounds(most | {name: 6}, {}).broken(house)) == 1
    large = make({"engine/loop.py": "\n" * 200})
    assert Bounds(most | {name: 208, "names that cross rooms": 4}, {}).broken(large) == []


def test_bounds_are_narrowed_and_never_widened(make: Make) -> None:
    gone = '\n[[up]]\nreason = "not yet"\nfiles = [\n    "engine/loop.py -> figures, later",\n]\n'
    kept = '\n[[up]]\nreason = "it draws itself"\nfiles = [\n    "run/simulate.py -> cli, later",\n]\n'
    house = make({"run/simulate.py": "def f():\n    import stickslip.cli", "cli/__init__.py": ""})
    wide = BOUNDS.replace("= 5", "= 50").replace('rooms" = 4', 'rooms" = 1')
    text = lowered(wide + gone + kept, house)
    assert text == wide.replace("= 50", "= 5") + kept
    assert [line for line in Bounds.read(text).broken(house) if "allowed" in line] == [
        "names that cross rooms: 3, and 1 are allowed"
    ]
