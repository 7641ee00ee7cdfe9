"""Do the tests notice? Wrong versions of the source, one at a time, and what the tests say to each.

    python -m benchmarks.mutation_map tests/contact tests/observables tests/engine ... --map reach.jsonl     # once
    python -m benchmarks.mutations --map reach.jsonl --named                                                     # mistakes by name
    python -m benchmarks.mutations --map reach.jsonl --count 40 --seed 1 --only contact --results mutations.jsonl

The tests that enter the changed function run first, quick ones first, up to the first failure. Where all pass, hashes of a fixed
suite (`benchmarks.mutation_check`) decide between "survived" and "equivalent". Results are appended to a file and not made again;
Ctrl-C ends with the table. A mutant of Python code takes seconds, one of the engine the compilation of what depends on it.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import sys
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.mutants import PACKAGES, SOURCE, Mutant, drawn, named
from benchmarks.mutation_map import Reach
from benchmarks.mutation_reach import depends_on_no_cache, must_compile
from benchmarks.mutation_trial import TREE, exchange, function_around, hashes, import_changed, in_child, make_hot, run_tests, runs

LIMITS = {"exchanged": 25.0, "imported": 25.0, "compiled": 90.0}
FIRST_SECONDS = {"exchanged": 4.0, "imported": 6.0, "compiled": 50.0}
"""Seconds of processor time for the tests of one mutant, and for those before the hashes; the last test that began may end."""
ENGINE_TESTS = (
    "tests/engine/test_verified_numbers.py",
    "tests/engine/test_event_sequences.py",
    "tests/adversarial/test_known_failures.py",
    "tests/engine/test_located_events.py",
    "tests/engine/test_solution.py",
    "tests/engine/test_certificate.py",
    "tests/reference",
)
"""Where mistakes in compiled code show soonest."""


class Campaign:
    """What is known of the tests, and the hashes without any mutant."""

    def __init__(self, options: argparse.Namespace) -> None:
        self.reach, self.left_out = Reach(options.map), set(options.deselect)
        self.path, self.quick = Path(options.results), options.quick
        self.results = _known(options.results, options.quick)
        self.places = sorted({test.split("::")[0] for test in self.reach.seconds})
        self.runs: Any = None
        self.before = self.hashes_before(options.map.with_suffix(".hashes.json"))

    def hashes_before(self, path: Path) -> dict[str, str]:
        """Hashes of the source as it is, kept beside the map."""
        digest = hashlib.sha256()
        for file in sorted((TREE / SOURCE).rglob("*.py")):
            digest.update(file.read_bytes())
        if path.exists():
            kept = json.loads(path.read_text())
            if kept["source"] == digest.hexdigest():
                return dict(kept["hashes"])
        found = in_child(lambda _: {"hashes": hashes()})
        if "hashes" not in found:
            raise SystemExit(f"mutations: without any mutant the suite fails: {found}")
        path.write_text(json.dumps({"source": digest.hexdigest(), "hashes": found["hashes"]}))
        return dict(found["hashes"])

    def kind(self, mutant: Mutant) -> str:
        """What a mutant needs: "exchanged" code, a changed text "imported", or the engine "compiled"."""
        if depends_on_no_cache(mutant.path) or must_compile(TREE, mutant):
            return "compiled"
        return "exchanged" if function_around((TREE / SOURCE / mutant.path).read_bytes(), mutant) else "imported"

    def rank(self, mutant: Mutant, kind: str) -> dict[str, float]:
        """The tests for a mutant in their order, with their usual seconds."""
        function = function_around((TREE / SOURCE / mutant.path).read_bytes(), mutant)
        if kind == "compiled":
            tests = self.reach.of("run/run_loop.py", None)
        else:
            tests = self.reach.of(mutant.path, function if kind == "exchanged" else None)
        near = tests if kind == "imported" else set()
        tests = tests if kind != "imported" else set(self.reach.seconds)  # not every use of a number enters a function of its file
        killers = Counter(result["by"] for result in self.results if result["path"] == mutant.path)

        def order(test: str) -> tuple[int, bool, int, float]:
            first = [n for n, place in enumerate(ENGINE_TESTS) if test.startswith(place)] if kind == "compiled" else []
            return -killers[test], test not in near, first[0] if first else len(ENGINE_TESTS), self.reach.seconds[test]

        return {test: self.reach.seconds[test] for test in sorted(tests - self.left_out, key=order)}

    def tried(self, mutant: Mutant, kind: str) -> dict[str, Any]:
        """What becomes of one mutant."""
        rank, began = self.rank(mutant, kind), time.monotonic()

        def work(note: Callable[[str], None]) -> dict[str, Any]:
            if kind != "exchanged":
                import_changed(mutant)
            elif not exchange(mutant):
                return {"broken": "the code cannot be exchanged"}
            return self.judged(rank, kind, note, mutant.package)

        found = in_child(work)
        changed = sum(found.get("hashes", {}).get(name) != value for name, value in self.before.items())
        verdict, by = self.verdict(found, changed, len(rank))
        took = round(time.monotonic() - began, 1)
        return {
            "mutant": mutant.name,
            "path": mutant.path,
            "kind": kind,
            "verdict": verdict,
            "by": by,
            "passed": found.get("passed", -1),
            "changed": -1 if verdict not in ("survived", "equivalent") else changed,
            "seconds": took,
        }

    def judged(self, rank: dict[str, float], kind: str, note: Callable[[str], None], package: str) -> dict[str, Any]:
        """Run the first tests, then the hashes, and the other tests only if a hash has changed."""
        found = run_tests(rank, FIRST_SECONDS[kind], note)
        if found["failed"] or self.quick:
            return found
        note("the hashes")
        found["hashes"] = hashes(self.runs if package == "observables" and kind == "exchanged" else None)
        if found["unfinished"] and any(found["hashes"].get(name) != value for name, value in self.before.items()):
            rest = dict(list(rank.items())[found["passed"] :])
            later = run_tests(rest, LIMITS[kind], note)
            found |= {**later, "passed": found["passed"] + later["passed"]}
        return found

    @staticmethod
    def verdict(found: dict[str, Any], changed: int, tests: int) -> tuple[str, str]:
        """The verdict, and the test or the reason."""
        if "died" in found:
            return "caught", f"{found['during'] or 'import'} (killed by signal {found['died']})"
        if "broken" in found:
            return "broken", found["broken"]
        if found["failed"]:
            return "caught", found["failed"]
        tests = f"{found['passed']} of {tests} tests passed" + (", then the time was up" if found["unfinished"] else "")
        if "hashes" not in found:
            return "pending", tests
        return ("survived" if changed else "equivalent"), tests

    def run(self, wanted: list[Mutant]) -> None:
        """Try the mutants that have no result yet: those that need an import of their own first, then the others."""
        known = {result["mutant"] for result in self.results}
        kinds = {mutant: self.kind(mutant) for mutant in wanted if mutant.name not in known}
        for mutant in [one for kind in ("imported", "compiled") for one in kinds if kinds[one] == kind]:
            self.tell(mutant, kinds[mutant])
        hot = [one for one in kinds if kinds[one] == "exchanged"]

        def work() -> None:
            self.runs = runs()
            for mutant in hot:
                self.tell(mutant, "exchanged")

        if hot:
            make_hot(self.places, work)

    def tell(self, mutant: Mutant, kind: str) -> None:
        """Try a mutant; print and keep the result."""
        result = self.tried(mutant, kind)
        self.results.append(result)
        with self.path.open("a") as file:
            file.write(json.dumps(result) + "\n")
        say(f"{len(self.results)}: {result['verdict']:10} {result['seconds']:6.1f} s  {result['mutant']}  {result['by'][:90]}")


def _known(path: str, quick: bool) -> list[dict[str, Any]]:
    """Results of earlier campaigns in the file; pending ones only if they are not to be decided now."""
    if not Path(path).exists():
        return []
    results = {one["mutant"]: one for one in map(json.loads, Path(path).read_text().splitlines())}
    return [one for one in results.values() if quick or one["verdict"] != "pending"]


def say(text: str) -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def table(results: list[dict[str, Any]]) -> None:
    """Counts by package and verdict, then the survivors."""
    verdicts = ("caught", "survived", "equivalent", "broken", "pending")
    counts = Counter((result["path"].split("/")[0], result["verdict"]) for result in results)
    say(f"\n{'package':16}" + "".join(f"{verdict:>12}" for verdict in verdicts))
    for package in sorted({package for package, _ in counts}):
        say(f"{package:16}" + "".join(f"{counts[package, verdict]:12}" for verdict in verdicts))
    for result in results:
        if result["verdict"] == "survived":
            say(f"survived: {result['mutant']} ({result['changed']} hashes changed; {result['by']})")


def main() -> int:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutations", description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--named", action="store_true", help="the mistakes by name")
    parser.add_argument("--names", nargs="*", help="of the mutants only these")
    parser.add_argument("--count", type=int, default=0, help="random mutants")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", nargs="*", choices=PACKAGES, help="packages of the random mutants")
    parser.add_argument("--kinds", nargs="*", choices=tuple(LIMITS), help="of the mutants only those that need this")
    parser.add_argument("--quick", action="store_true", help="only the first tests; the others are decided without this option")
    parser.add_argument("--most", type=int, help="of the mutants only so many")
    parser.add_argument("--results", default="mutations.jsonl")
    parser.add_argument("--deselect", nargs="*", default=[], help="tests that fail without any mutant")
    parser.add_argument("--map", type=Path, required=True, help="what benchmarks.mutation_map recorded")
    options = parser.parse_args()
    wanted = named(TREE) if options.named else []
    wanted += drawn(TREE, options.count, options.seed, tuple(options.only or PACKAGES))
    if options.names:
        wanted = [one for one in wanted if one.name in options.names]
    campaign = Campaign(options)
    if options.kinds:
        wanted = [one for one in wanted if campaign.kind(one) in options.kinds]
    try:
        campaign.run(wanted[: options.most])
    except KeyboardInterrupt:
        say("interrupted")
    table(campaign.results)
    return 0


if __name__ == "__main__":
    sys.exit(main())
