"""A file of somebody else, to which a command was told to write by mistake, stays as it is."""

from __future__ import annotations

from pathlib import Path

import pytest

FOREIGN = b"# stick-slip tests, not made by stickslip\ntime,force\n0,1\n"
"""A file of somebody else that a command was told to write by mistake."""


@pytest.mark.parametrize(
    ("arguments", "file"),
    [
        (["schemes", "fig4-loop", "--nx", "20", "--out"], "data.csv"),
    ],
    ids=lambda one: one[0] if isinstance(one, list) else one,
)
def test_a_file_of_somebody_else_is_never_replaced(command, tmp_path: Path, arguments: list[str], file: str):
    (tmp_path / file).write_bytes(FOREIGN)
    (tmp_path / "points.csv").write_text("slip,friction\n0,0.6\n1,0.5\n2,0.4\n3,0.4\n")
    said = command(*arguments, file).refusal
    assert f"{file}: exists, and" in said
    assert said.endswith("choose another name, or remove it\n")
    assert (tmp_path / file).read_bytes() == FOREIGN
