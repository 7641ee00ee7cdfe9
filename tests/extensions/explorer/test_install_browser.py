"""The script that provides a browser takes the first that can be had, and says plainly when none can."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("install_browser.sh")


def command(folder: Path, name: str, code: int, said: str = "") -> None:
    """Put a command into a folder that notes that it was called, says something, and ends with a code."""
    path = folder / name
    path.write_text(f'#!/bin/sh\necho "{name} $*" >> "{folder}/calls"\necho "{said}"\nexit {code}\n', encoding="utf-8")
    path.chmod(0o755)


@pytest.mark.parametrize(
    ("commands", "said", "calls"),
    [
        ({"google-chrome": 0, "python": 0}, "browser: {}/google-chrome", []),
        ({"python": 0}, "browser: chromium, brought by playwright", ["python -m playwright install --with-deps chromium"]),
        ({"python": 1, "apt-get": 0}, "browser: chromium, installed by apt-get", ["apt-get update"]),
        (
            {"python": 1, "apt-get": 1},
            "browser: no chromium was found, and none could be installed: the browser tests",
            ["apt-get update"],
        ),
        ({"python": 1}, "browser: no chromium was found, and none could be installed: the browser tests", []),
    ],
)
def test_a_browser_is_found_or_installed_or_missed_in_one_line(
    commands: dict[str, int], said: str, calls: list[str], tmp_path: Path
) -> None:
    for name, code in commands.items():
        command(tmp_path, name, code)
    command(tmp_path, "id", 0, "0")  # as root
    found = subprocess.run(
        ["/bin/sh", SCRIPT, str(tmp_path / "python")], env={"PATH": str(tmp_path)}, capture_output=True, text=True, check=True
    )
    assert found.stderr == ""
    assert found.stdout.startswith(said.format(tmp_path))
    assert found.stdout.count("\n") == 1
    notes = tmp_path / "calls"
    called = notes.read_text(encoding="utf-8") if notes.exists() else ""
    assert all(call in called for call in calls)
    assert "apt-get" not in called or "apt-get" in "".join(calls)


def test_without_the_rights_of_root_nothing_is_installed(tmp_path: Path) -> None:
    for name in ("python", "apt-get"):
        command(tmp_path, name, 1)
    command(tmp_path, "id", 0, "1000")
    subprocess.run(["/bin/sh", SCRIPT, str(tmp_path / "python")], env={"PATH": str(tmp_path)}, capture_output=True, check=True)
    assert "apt-get" not in (tmp_path / "calls").read_text(encoding="utf-8")
