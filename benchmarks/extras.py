"""Each extra of a wheel in an environment of its own: what its installation takes, and whether its doors open.

Times are processor times: downloads come on top.

python -m hatchling build -d dist
python -m benchmarks.extras dist/stickslip-0.1.0-py3-none-linux_x86_64.whl                # all
python -m benchmarks.extras dist/stickslip-0.1.0-py3-none-linux_x86_64.whl video cluster  # some
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import venv
from pathlib import Path

from benchmarks import fresh

SERVED = """
import re, subprocess, sys, urllib.request
command = [sys.executable, "-m", "stickslip", "explore", "--no-browser", "--port", "0"]
server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
try:
    found = None
    while found is None:
        found = re.search("http://[^ ]+", server.stdout.readline())
    browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())  # the token of the address becomes a cookie
    page = browser.open(found[0].strip()).read().decode()
    assert "bokeh" in page, page[:500]
finally:
    server.terminate()
    server.wait()
"""
"""Start the server, and get its page."""
IN_NOTEBOOK = """
import asyncio
import stickslip as ss

async def cell():
    shown = ss.explore("fig6-slab")
    assert "23.44 m" in shown.explorer.answer.sentence
    assert shown._repr_mimebundle_()

asyncio.run(cell())
"""
"""Make what a notebook shows of the explorer."""
BUILT = """
import shutil, subprocess, sys
from pathlib import Path
for part in ("docs", "examples"):
    shutil.copytree(Path(sys.argv[1]) / part, part, ignore=shutil.ignore_patterns("_build", "gallery"))
subprocess.run([sys.executable, "-m", "sphinx", "-b", "html", "-q", "--fail-on-warning", "docs", "html"], check=True)
subprocess.run([sys.executable, "docs/site/check_site.py", "html"], check=True)
"""
"""Make the site of the pages in the folder that is given, from the installed package, and check its links."""
REFUSED = """
import subprocess, sys
done = subprocess.run([sys.executable, "-m", "stickslip", *sys.argv[1:]], capture_output=True, text=True)
assert done.returncode == 2 and "pip install" in done.stderr and done.stderr.count("\\n") == 1, done
"""
"""Run a command that must be refused in one line that says what to install."""
STICKSLIP = ("-m", "stickslip")
DOORS: dict[str, tuple[tuple[str, ...], ...]] = {
    "": (
        (*STICKSLIP, "doctor"),
        (*STICKSLIP, "run", "fig6-slab", "--figure", "run.png", "--animation", "slab.gif", "--out", "run.nc"),
        ("-c", REFUSED, "run", "cycles-block", "--catalogue", "events.parquet"),
        ("-c", REFUSED, "sweep", "fig6-slab", "-v", "alpha=1,2", "--workers", "1"),
        ("-c", REFUSED, "explore", "--no-browser"),
    ),
    "parquet": ((*STICKSLIP, "run", "cycles-block", "--catalogue", "events.parquet"), (*STICKSLIP, "show", "events.parquet")),
    "cluster": ((*STICKSLIP, "sweep", "fig6-slab", "-v", "alpha=0.5,1,2", "--workers", "1", "--out", "map.zarr"),),
    "video": ((*STICKSLIP, "run", "fig6-slab", "--animation", "slab.mp4"),),
    "explorer": (("-c", SERVED),),
    "notebook": (("-c", IN_NOTEBOOK),),
    "site": (("-c", BUILT, str(Path(__file__).parents[1])),),
}
"""What each extra is for, as arguments of Python; "" is the package without extras."""


def size(folder: Path) -> float:
    """Return the size of all files in a folder (MB)."""
    return sum(path.lstat().st_size for path in folder.rglob("*") if path.is_file() and not path.is_symlink()) / 1e6


def timed(*command: str | Path, folder: Path, cache: Path) -> float:
    """Run a command, and return its processor time (s). Raises SystemExit with its last lines if it fails."""
    clean = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONHOME")}
    done = fresh.run(command, folder, clean | {"STICKSLIP_CACHE_DIR": str(cache)})
    if done.code:
        raise SystemExit(f"{command}\n{done.out[-1500:]}\n{done.err[-1500:]}")
    return done.spent


def try_extra(wheel: Path, extra: str, cache: Path) -> str:
    """Install the wheel with an extra into an empty environment, open its doors, and return a row of the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        venv.create(folder / "venv", with_pip=True)
        python = folder / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"
        before = size(folder)
        wanted = f"{wheel}[{extra}]" if extra else str(wheel)
        installed = timed(python, "-m", "pip", "install", "--quiet", "--prefer-binary", wanted, folder=folder, cache=cache)
        added = size(folder) - before
        timed(python, "-m", "pip", "check", folder=folder, cache=cache)
        doors = sum(timed(python, *door, folder=folder, cache=cache) for door in DOORS[extra])
    return f"| {extra or 'none'} | {installed:.0f} s | {added:.0f} MB | {doors:.0f} s |"


def main() -> None:
    """Try the extras that are named, or all."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wheel", type=Path)
    parser.add_argument("extras", nargs="*", help=f"of {', '.join(filter(None, DOORS))}; all if none is named")
    given = parser.parse_args()
    print(f"Python {sys.version.split()[0]}\n\n| extra | installation | size | its doors |\n| --- | --- | --- | --- |", flush=True)  # noqa: T201 - a script
    with tempfile.TemporaryDirectory() as cache:
        for extra in given.extras or DOORS:
            print(try_extra(given.wheel.resolve(), extra, Path(cache)), flush=True)  # noqa: T201 - a script


if __name__ == "__main__":
    main()
