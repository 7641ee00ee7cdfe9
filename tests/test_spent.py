"""The table of what tests take of the processor."""

from __future__ import annotations

from collections import Counter

import pytest

from tests.spent import Clock, folder_of, table_of


@pytest.mark.parametrize(
    ("test", "folder"),
    [
        ("tests/core/engine/truth/test_a.py::test_b[c/d::e]", "core/engine"),
        ("tests/core/test_a.py::test_b", "core"),
        ("tests/extensions/planar/test_a.py::test_b", "extensions/planar"),
        ("tests/docs/site/test_a.py::test_b", "docs"),
        ("tests/test_a.py::test_b", "above them"),
    ],
)
def test_a_test_counts_for_its_room_or_its_extension(test: str, folder: str) -> None:
    assert folder_of(test) == folder


def test_the_table_begins_with_the_dearest_and_tells_small_ones_together() -> None:
    spent, tests = Counter({"a": 20.0, "b": 179.0, "c": 0.6, "d": 0.4}), Counter(a=3, b=4, c=5, d=6)  # type: ignore[var-annotated]
    assert [line.split() for line in table_of(spent, tests)] == [
        ["179", "s", "90%", "4", "b"],
        ["20", "s", "10%", "3", "a"],
        ["1", "s", "11", "elsewhere"],
        ["200", "s", "18", "in", "all"],
    ]


def test_a_lap_is_what_this_process_and_its_children_spent_since_the_last_one(monkeypatch: pytest.MonkeyPatch) -> None:
    times = iter([(1.0, 0.5, 0.0, 0.0, 7.0), (2.0, 0.75, 4.0, 0.25, 9.0), (2.0, 0.75, 4.0, 0.25, 11.0)])
    with monkeypatch.context() as patched:  # the table of these tests is made by the true clock
        patched.setattr("os.times", lambda: next(times))
        clock = Clock()
        laps = [clock.lap(), clock.lap()]
    assert laps == [5.5, 0.0]
