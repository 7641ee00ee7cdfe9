"""Classes by kind are imported when they are asked for, and a user may add one."""

from __future__ import annotations

import subprocess
import sys

import pytest

from stickslip.foundation.classes_by_kind import ClassesByKind
from stickslip.friction import LAWS
from stickslip.problem.bodies import BODIES


@pytest.mark.parametrize("classes", [LAWS, BODIES], ids=["laws", "bodies"])
def test_each_class_stands_under_its_own_kind(classes: ClassesByKind[type]) -> None:
    assert {kind: one.kind for kind, one in classes.items()} == {kind: kind for kind in classes}  # type: ignore[attr-defined]


def test_a_kind_is_known_before_its_class_is_loaded() -> None:
    code = """
import sys
from stickslip.friction import LAWS
from stickslip.problem.bodies import BODIES
given = ("stickslip.friction.laws.", "stickslip.problem.bodies.uniform.string")
loaded = lambda: {name for name in sys.modules if name.startswith(given)}
assert "dahl" in LAWS and "torsional-string" in BODIES and "dahll" not in LAWS and len(LAWS) > 20 and not loaded()
assert LAWS["dahl"].__name__ == "Dahl"
assert loaded() == {"stickslip.friction.laws.bristles"}, loaded()
"""
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False).stderr == ""


def test_a_class_of_a_user_takes_its_kind_and_gives_it_back() -> None:
    classes: ClassesByKind[object] = ClassesByKind("collections", {"first": "abc.Mapping"})
    classes["own"] = int
    classes["first"] = float
    assert dict(classes) == {"first": float, "own": int}
    del classes["own"]
    assert list(classes) == ["first"]
    with pytest.raises(KeyError):
        classes["own"]
