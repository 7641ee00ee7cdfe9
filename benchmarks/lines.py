"""Count the lines of the package by room, as a table for README.md: `python -m benchmarks.lines`."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
CORE = "engine friction batch foundation run contact planar schemes reference engine_input creep trajectory problem bodies loading"


def lines(room: Path) -> tuple[int, int]:
    """Return the number of files, and of lines, of Python in a file or below a folder."""
    files = [room] if room.is_file() else room.rglob("*.py")
    found = [path.read_text(encoding="utf-8").count("\n") for path in files]
    return len(found), sum(found)


def main() -> None:
    """Print the table: the core, which decides results, then what is around it."""
    package = ROOT / "src" / "stickslip"
    core = CORE.split()
    paths = [
        path
        for path in sorted(package.iterdir())
        if (path / "__init__.py").is_file() or (path.suffix == ".py" and path.stem in core)
    ]
    rooms = {path.stem: lines(path) for path in paths}
    rows = [(name, *rooms[name]) for name in core]
    rows.append(("**core**", *map(sum, zip(*(rooms[name] for name in core), strict=True))))
    rows += [(name, *found) for name, found in rooms.items() if name not in core]
    rows += [("**all**", *lines(package)), ("tests", *lines(ROOT / "tests"))]
    sys.stdout.write("| room | files | lines |\n| --- | --- | --- |\n")
    sys.stdout.write("".join(f"| {name} | {files} | {count} |\n" for name, files, count in rows))


if __name__ == "__main__":
    main()
