"""Scenarios: one TOML file that says what to simulate, and the bundled ones."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario, load_scenario, read_scenario
    from stickslip.scenarios.templates import template, template_names

__all__ = ["Scenario", "load_scenario", "read_scenario", "template", "template_names"]


def __getattr__(name: str) -> Any:
    """Import on first use: pydantic is not needed to complete a name in the shell."""
    if name in __all__:
        from stickslip.scenarios import scenario, templates

        return getattr(templates if name.startswith("template") else scenario, name)
    raise AttributeError(f"module 'stickslip.scenarios' has no attribute '{name}'")
