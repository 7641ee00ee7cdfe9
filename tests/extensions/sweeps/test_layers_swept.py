"""Numbers of layers are swept."""

from __future__ import annotations

import stickslip as ss


def test_a_number_of_one_layer_is_swept() -> None:
    table = ss.sweep("low-velocity-zone", {"body.wave_speed[0]": [1750.0, 3500.0]})
    assert table.events.values.tolist() == [2, 1]
