"""Count the lines of the package that a thing loads: files that were imported when it is done, whether it entered them or not.

Usage: python -m benchmarks.loaded [NAME ...]   NAME: one of THINGS; with --files the files of each, largest first.

Each is done in a process of its own. tests/test_loaded.py holds the numbers down: a reader who follows a run meets these lines.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

THINGS = {
    "import": "import stickslip",
    "simulate": "import stickslip; stickslip.simulate('fig6-slab')",
    "uniqueness": "import stickslip; stickslip.uniqueness('fig6-slab')",
    "planar": "import stickslip; stickslip.simulate('planar-patch', duration=0.05)",
    "run": "from stickslip.cli.main import main; main(['run', 'fig6-slab'])",
    "check": "from stickslip.cli.main import main; main(['check', 'fig6-slab'])",
}
"""What is done, by its name here: a scenario from the bundled ones, by Python or by the command line."""
ASK = """
import json as _json, sys as _sys
_files = {name: getattr(module, "__file__", None) for name, module in list(_sys.modules.items())}
print("\\n" + _json.dumps({name: file for name, file in _files.items() if file}))
"""
"""Code that says, in one last line, which modules are loaded, and from which files."""


def loaded(code: str) -> dict[str, str]:
    """Return the modules that are loaded after some code has run in a process of its own, each with its file."""
    framed = f"try:\n    {code}\nexcept SystemExit as end:\n    assert not end.code\n{ASK}"
    done = subprocess.run([sys.executable, "-c", framed], capture_output=True, text=True, check=True, encoding="utf-8")
    found: dict[str, str] = json.loads(done.stdout.splitlines()[-1])
    return found


def lines_of(modules: dict[str, str], package: str = "stickslip") -> dict[str, int]:
    """Return the number of lines of each of the modules that belong to a package."""
    own = {name: Path(file) for name, file in modules.items() if name == package or name.startswith(f"{package}.")}
    return {name: len(path.read_text(encoding="utf-8").splitlines()) for name, path in own.items()}


def main(arguments: list[str]) -> None:
    """Print the lines and the modules of each thing that is named, by default of all."""
    names = [one for one in arguments if one != "--files"] or list(THINGS)
    for name in names:
        lines = lines_of(loaded(THINGS[name]))
        sys.stdout.write(f"{name:12} {sum(lines.values()):6} lines in {len(lines):3} modules\n")
        if "--files" in arguments:
            for module, count in sorted(lines.items(), key=lambda one: -one[1]):
                sys.stdout.write(f"    {count:5} {module}\n")


if __name__ == "__main__":
    main(sys.argv[1:])
