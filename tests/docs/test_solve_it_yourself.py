"""The page on other solvers says what SciPy does, and names scripts that are there, with the versions that these install."""

from __future__ import annotations

import math
import os
import re

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from tests.docs.pages import PAGES, ROOT

PAGE = (ROOT / "docs" / "solve-it-yourself.md").read_text(encoding="utf-8")
SCRIPTS = sorted((ROOT / "findings").glob("*.sh"))
NAMED = re.compile(r"findings/([\w-]+\.sh)")
PINNED = re.compile(r'"([\w.-]+)==([\w.]+)"')
PACKAGES = {"OpenSeesPy": "openseespy", "openTorsion": "opentorsion", "DART (dartpy": "dartpy"}
"""Names of packages that the page writes otherwise than those who install them."""
BLOCK = ss.SpringBlock(mass=1.0, stiffness=0.0, normal_force=1.0)
DRY = ss.friction.Coulomb(static=1.0, dynamic=1.0)


def rate_of_bdf(force: float, start: float) -> tuple[int, float]:
    """Return status and last slip rate of a mass of 1 kg under a force (N) and friction of 1 N times sign(v), after 10 s."""
    found = solve_ivp(lambda t, y: [y[1], force - np.sign(y[1])], (0.0, 10.0), [0.0, start], method="BDF")
    return found.status, float(found.y[1, -1])


@pytest.mark.parametrize("force", [0.1, 0.5, 0.9])
def test_a_block_at_rest_flies_off_by_bdf_and_rests_here(force: float) -> None:
    status, rate = rate_of_bdf(force, 0.0)
    assert status == 0
    assert rate == pytest.approx(10.0 * force, rel=1e-4)  # as without friction: F t/m
    run = ss.simulate(ss.Problem(BLOCK, DRY, initial_load=force), 10.0)
    assert run.slip_rate(10.0) == run.slip(10.0) == 0.0


def test_a_short_stop_is_found_here_to_rounding() -> None:
    """The rate is (t - 1)^2 - 0.01 up to 0.9 s, and (t - 1)^2 from 1 s on."""
    ramp = ss.loading.PiecewiseLinear(times=[0.0, 4.0], values=[-1.0, 7.0])
    run = ss.simulate(ss.Problem(BLOCK, DRY, initial_load=0.0, initial_rate=0.99, force=ramp), 4.0)
    assert list(run.events.start) == pytest.approx([0.0, 1.0], abs=1e-9)
    assert run.events.end[0] == pytest.approx(0.9, abs=1e-12)
    assert run.slip(4.0) == pytest.approx(0.324 + 9.0, abs=1e-12)


def test_a_mass_on_a_spring_comes_to_rest_where_swings_say() -> None:
    """Each half period takes 2 m off the swing, whose first is sqrt(26) - 1 m after a throw at 5 m/s."""
    sprung = ss.SpringBlock(mass=1.0, stiffness=1.0, normal_force=1.0)
    run = ss.simulate(ss.Problem(sprung, DRY, initial_load=0.0, initial_rate=5.0), 40.0)
    assert run.slip(40.0) == pytest.approx(math.sqrt(26.0) - 5.0, abs=1e-9)
    assert run.events.end.iloc[-1] == pytest.approx(math.atan(5.0) + 2.0 * math.pi, abs=1e-9)


def test_scripts_that_pages_name_are_there() -> None:
    named = {name for page in PAGES for name in NAMED.findall(page.read_text(encoding="utf-8"))}
    assert named <= {script.name for script in SCRIPTS}
    assert len(NAMED.findall(PAGE)) >= 10


def test_scripts_pin_what_they_install_and_fail_if_it_changes() -> None:
    for script in SCRIPTS:
        text = script.read_text(encoding="utf-8")
        assert os.access(script, os.X_OK), script.name
        assert text.startswith("#!/usr/bin/env bash\n# "), script.name
        assert "set -euo pipefail" in text, script.name
        assert re.search(r"\w==[\d$]", text), script.name


def test_versions_of_the_page_are_those_of_its_scripts() -> None:
    texts = {name: (ROOT / "findings" / name).read_text(encoding="utf-8") for name in NAMED.findall(PAGE)}
    pinned = {name.lower(): version for text in texts.values() for name, version in PINNED.findall(text)}
    told = re.findall(r"(DART \(dartpy|\w+) (\d+\.\d+\.\d[\d.]*)", PAGE)
    known = {(name, version.rstrip(".")) for name, version in told if PACKAGES.get(name, name).lower() in pinned}
    assert len({name for name, _ in known}) >= 10
    assert [(name, version) for name, version in known if pinned[PACKAGES.get(name, name).lower()] != version] == []
