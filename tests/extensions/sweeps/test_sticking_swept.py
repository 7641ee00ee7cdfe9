"""Sweeps keep the share of the time that a contact sticks."""

from __future__ import annotations

import stickslip as ss


def test_a_block_that_never_slips_sticks_all_the_time() -> None:
    swept = ss.sweep(ss.scenarios["fig6-block-printed"], {"alpha": [1.0]}, quantities=["sticking"])
    assert float(swept.sticking[0]) == 1.0
