"""The explorer offers the numbers of a normal load that varies."""

from __future__ import annotations

import stickslip as ss
from stickslip.problem.loading import Sinusoidal

STATIC, DYNAMIC, FORCE, STIFFNESS, PULL, LOAD = 0.6, 0.4, 10.0, 100.0, 0.05, 5.0


BODY = ss.SpringBlock(mass=1.0, stiffness=STIFFNESS, normal_force=FORCE)


def block(history: object, **more: object) -> ss.Problem:
    """Return a block under Coulomb friction and a normal force that varies."""
    law = ss.friction.Coulomb(static=STATIC, dynamic=DYNAMIC)
    return ss.Problem(BODY, law, pull_rate=PULL, initial_load=LOAD, normal_load=history, **more)  # type: ignore[arg-type]


def test_the_explorer_offers_its_numbers_and_no_number_in_its_place() -> None:
    from stickslip.extensions.explorer.model.controls import controls_of
    from stickslip.extensions.explorer.model.setting import Setting
    from stickslip.problem.scenarios.scenario import Scenario

    shown = {
        constant: {one.path for group in controls_of(Setting.of(Scenario(problem, 3.0))) for one in group.controls}
        for constant, problem in ((True, block(None)), (False, block(Sinusoidal(10.0, 3.0, 0.37))))
    }
    assert not any("normal_load" in path for path in shown[True])
    assert {path.rpartition(".")[2] for path in shown[False] if "normal_load" in path} == {"mean", "amplitude", "period", "phase"}
