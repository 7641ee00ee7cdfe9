"""The dashpot beside a block's spring is offered in the explorer."""

from __future__ import annotations

from stickslip.extensions.explorer.model.controls import controls_of
from stickslip.extensions.explorer.model.setting import Setting


def test_the_explorer_has_a_slider_for_it() -> None:
    found = {one.path: one for group in controls_of(Setting.bundled("cycles-block")) for one in group.controls}
    slider = found["body.driver_damping"].slider
    assert slider is not None
    assert slider == found["body.damping"].slider
