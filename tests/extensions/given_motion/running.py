"""Commands as tests of given motion run them."""

from __future__ import annotations

import pytest

from stickslip.cli.main import main


def stickslip(*words: object) -> None:
    """Run a command, which must succeed."""
    with pytest.raises(SystemExit) as ended:
        main([str(one) for one in words])
    assert ended.value.code in (0, None)


def refused(*words: object) -> None:
    """Run a command, which must fail with the code of a wrong input."""
    with pytest.raises(SystemExit) as ended:
        main([str(one) for one in words])
    assert ended.value.code == 2
