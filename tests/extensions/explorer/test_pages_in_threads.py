"""Pages of the explorer that begin at once, each in threads of its own."""

from __future__ import annotations

from pathlib import Path
from uuid import uuid4

import pytest

from tests.core.engine.at_once import SETTING, python

AT_ONCE = """
from queue import Queue
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.server.desk import ThreadDesk
from stickslip.problem.scenarios.scenario import Scenario
calls, found, faults, scenario = Queue(), [], [], Scenario(problem(0), 20.0)
desks = [ThreadDesk(calls.put) for _ in range(8)]
for desk in desks:
    desk.ask(lambda told: solve(scenario, told).sentence, found.append, faults.append)
while len(found) + len(faults) < 8:
    calls.get(timeout=600)()
assert len(set(found)) == 1 and not faults, (found, faults)
"""


@pytest.mark.slow
def test_eight_pages_of_the_explorer_at_once() -> None:
    python(SETTING + AT_ONCE, uuid4().hex)


@pytest.mark.slow
def test_eight_pages_of_the_explorer_begin_with_an_empty_cache(tmp_path: Path) -> None:
    python(SETTING + AT_ONCE, uuid4().hex, STICKSLIP_CACHE_DIR=str(tmp_path))
