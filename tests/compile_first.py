"""Compile what most tests need of the engine, once: processes that test side by side would each do it for themselves."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import stickslip as ss
from stickslip.engine.on_demand import PARTS, function_of, part_at
from stickslip.run.check.examine import examine

SCENARIOS = ("fig6-slab", "rate-and-state-block", "cycles-block", "tides-block", "stress-pulse-slab", "second-event-perfect-delay")
"""Runs that use, together, what is compiled for most problems."""


def main() -> None:
    """Run and check, and do what the tests of extensions need; the machine code stays in the cache on disk."""
    for part in PARTS:
        part_at(function_of(part))
    for name in SCENARIOS:
        scenario = ss.load_scenario(name)
        repr(ss.simulate(scenario))  # with events and all else that a summary compiles
        examine(scenario)
    for path in sorted(Path(__file__).with_name("extensions").glob("*/compile_first.py")):
        import_module(f"{__package__}.extensions.{path.parent.name}.compile_first").main()


if __name__ == "__main__":
    main()
