"""The draw of the cases of sampled tests: one of each few, the same for the same seed, others in another week."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from tests import conftest
from tests.sampling import FIRST, drawn

WEEKS = [f"2026-W{week:02}" for week in range(1, 54)]


def test_without_a_seed_the_first_of_each_few_are_run() -> None:
    assert drawn("a", 8, 3, FIRST) == {0, 3, 6}
    assert drawn("a", 6, 3, FIRST) == {0, 3}
    assert drawn("a", 2, 7, FIRST) == {0}


@pytest.mark.parametrize("cases", [1, 5, 12, 100])
def test_every_draw_takes_one_of_each_few(cases: int) -> None:
    for week in WEEKS:
        found = sorted(drawn("a", cases, 5, week))
        assert [number // 5 for number in found] == list(range(-(-cases // 5)))
        assert found[-1] < cases


def test_the_printed_seed_repeats_its_draw() -> None:
    assert drawn("a", 100, 5, "2026-W48") == drawn("a", 100, 5, "2026-W48")
    assert sorted(drawn("tests/test_a.py::test_b", 30, 5, "2026-W48")) == [2, 6, 11, 17, 21, 27]  # in every process


def test_each_week_and_each_test_has_a_draw_of_its_own() -> None:
    assert len({drawn("a", 100, 5, week) for week in WEEKS}) == len(WEEKS)
    assert drawn("a", 100, 5, WEEKS[0]) != drawn("b", 100, 5, WEEKS[0])


def test_within_a_year_every_case_is_run() -> None:
    found = [number for week in WEEKS for number in drawn("a", 40, 4, week)]
    assert set(found) == set(range(40))
    assert max(map(found.count, range(40))) < 30  # one in four of 53 is 13


class Item:
    """A test as pytest has collected it."""

    def __init__(self, nodeid: str, every: int | None) -> None:
        self.nodeid, self.slow = nodeid, False
        self._marker = None if every is None else pytest.mark.sampled(every=every).mark

    def get_closest_marker(self, name: str) -> Any:
        return self._marker

    def add_marker(self, marker: pytest.MarkDecorator) -> None:
        self.slow = marker.name == "slow"


def test_what_is_not_drawn_is_slow_and_other_tests_stay() -> None:
    plain = [Item(f"t.py::plain[{n}]", None) for n in range(5)]
    ours = [Item(f"t.py::ours[{n}]", 5) for n in range(30)]
    for draw in (FIRST, "2026-W48"):
        for item in ours:
            item.slow = False
        config: Any = SimpleNamespace(getoption={"--draw": draw}.get)
        conftest.pytest_collection_modifyitems(config, [*plain, *ours])  # type: ignore[list-item]
        assert not any(item.slow for item in plain)
        assert {n for n, item in enumerate(ours) if not item.slow} == drawn("t.py::ours", 30, 5, draw)


def test_the_header_says_how_to_repeat_the_draw() -> None:
    config: Any = SimpleNamespace(getoption={"--draw": "2026-W48"}.get)
    assert "sampled cases: those of --draw=2026-W48" in conftest.pytest_report_header(config)
