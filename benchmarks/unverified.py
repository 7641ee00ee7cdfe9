"""`python -m benchmarks.unverified`: what the certificate and the guards of each step cost, by a build of the engine without them.

The package is copied, the functions in WITHOUT get the bodies that stand there, and both packages run the same members and single
runs in turn, each in processes of its own. The build without proofs is for this measurement only: it accepts wrong steps.
"""

from __future__ import annotations

import ast
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

PACKAGE = Path(__file__).parents[1] / "src" / "stickslip"
WITHOUT = {
    "engine/contact_step/certificate.py": {
        "proven_length": "powers_of(length, run.powers); multiply(run.jet, run.powers, terms_of(run)); return length",
        "measure_end": "return 0.0",
        "is_negative": "return False",
    },
    "engine/contact_step/negative_friction.py": {"goes_below_zero": "return False"},
    "engine/lanes/lanes.py": {
        "prove": "stretch(lanes); lanes.share = lanes.state.residual = lanes.state.unbalanced = 0.0",
        "check_end": "return (lanes.rate[0] > 0.0) & (bound_below(lanes.rate) > 0.0) & (abs(lanes.rate_end) < math.inf)",
    },
}
"""Bodies of functions in the build without proofs; that slip goes on to the end of the step is no proof, and is still checked."""
TURNS, ROUNDS, MEMBERS, CALLS = 3, 5, 2000, 300
"""Processes for each package, measurements in each, members of a batch, and calls of a single run."""


def strip(package: Path) -> None:
    """Replace the functions of WITHOUT in a copy of the package."""
    for name, bodies in WITHOUT.items():
        text = (package / name).read_text()
        lines, missing = text.splitlines(), set(bodies)
        for node in reversed(ast.parse(text).body):
            if isinstance(node, ast.FunctionDef) and node.name in bodies:
                lines[node.body[0].lineno - 1 : node.end_lineno] = [f"    {bodies[node.name]}"]
                missing.discard(node.name)
        assert not missing, f"{name} has no functions {missing}"
        (package / name).write_text("\n".join(lines) + "\n")


def measure() -> dict[str, float]:
    """Return the processor time (us) of each member of the batches and of each single run: medians."""
    from benchmarks.ours import runner
    from benchmarks.problems import CASES
    from benchmarks.sweeps import TASKS
    from stickslip.extensions.sweeps.batch import run_members

    found = {}
    for task in TASKS:
        members = MEMBERS * task.more
        values = {task.key: task.numbers(members)}
        found[f"batch: {task.title}"] = timed(lambda: run_members(task.scenario, values, ("slip",), 1)) / members  # noqa: B023
    for case in CASES:
        run = runner(case, 1e-9).run
        found[f"one run: {case.title}"] = timed(lambda: [run() for _ in range(CALLS)]) / CALLS  # noqa: B023
    return found


def timed(work: object) -> float:
    """Return the median processor time (us) of some work, after one run that does not count."""
    taken = []
    for _ in range(ROUNDS + 1):
        start = time.process_time()
        work()  # type: ignore[operator]
        taken.append(1e6 * (time.process_time() - start))
    return median(taken[1:])


def main() -> None:
    """Print the table of benchmarks/README.md."""
    if "--measure" in sys.argv:
        print(json.dumps(measure()))  # noqa: T201
        return
    with TemporaryDirectory() as folder:
        copy = Path(folder) / "stickslip"
        shutil.copytree(PACKAGE, copy)
        strip(copy)
        taken: list[list[dict[str, float]]] = [[], []]
        for _ in range(TURNS):
            for number, source in enumerate((PACKAGE.parent, copy.parent)):
                command = [sys.executable, "-m", "benchmarks.unverified", "--measure"]
                done = subprocess.run(command, env={**os.environ, "PYTHONPATH": str(source)}, stdout=subprocess.PIPE, check=True)
                taken[number].append(json.loads(done.stdout))
    print("| work | with | without | share of the proofs |\n| --- | --- | --- | --- |")  # noqa: T201
    for name in taken[0][0]:
        proven, bare = (median(one[name] for one in rounds) for rounds in taken)
        print(f"| {name} | {proven:.3g} us | {bare:.3g} us | {100.0 * (proven / bare - 1.0):.0f} % |")  # noqa: T201


if __name__ == "__main__":
    main()
