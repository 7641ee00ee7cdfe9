"""Scenarios: TOML files that say what to simulate, and those that come with the package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stickslip.problem.scenarios.scenario import Scenario, load_scenario, read_scenario

__all__ = ["Scenario", "load_scenario", "read_scenario"]


def __getattr__(name: str) -> Any:
    """Import a name when it is first used, because completion in the shell must not wait for all that reads them."""
    if name in __all__:
        from stickslip.problem.scenarios import scenario

        return getattr(scenario, name)
    raise AttributeError(f"module 'stickslip.problem.scenarios' has no attribute '{name}'")
