"""Sensitivities: derivatives of any output of a run with respect to the numbers of its problem, with their errors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class SensitivityExtension(Extension):
    """The study `sensitivity`, and its command."""

    name = "sensitivity"

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command."""
        from stickslip.extensions.sensitivity.commands.sensitivity import sensitivity

        return {"Questions that need many runs": (sensitivity,)}

    def public(self) -> Mapping[str, str]:
        """Return the study and the class of its result."""
        home = "stickslip.extensions.sensitivity"
        return {
            "studies.Sensitivity": f"{home}.result:Sensitivity",
            "studies.sensitivity": f"{home}.study:sensitivity",
        }


EXTENSION = SensitivityExtension()
