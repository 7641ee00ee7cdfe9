"""Scenarios: TOML files that say what to simulate, and those that come with the package."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario, load_scenario, read_scenario
    from stickslip.scenarios.templates import template, template_names

__all__ = ["Scenario", "load_scenario", "read_scenario", "template", "template_names"]


def __getattr__(name: str) -> Any:
    """Import a name when it is first used, because completion in the shell must not wait for all that reads them."""
    if name in __all__:
        from stickslip.scenarios import scenario, templates

        return getattr(templates if name.startswith("template") else scenario, name)
    raise AttributeError(f"module 'stickslip.scenarios' has no attribute '{name}'")
