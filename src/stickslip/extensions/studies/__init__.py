"""Studies: several runs side by side, block against slab, and ensembles of runs with small differences."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class StudiesExtension(Extension):
    """The studies `compare`, `analogy` and `ensemble`, each as a command and in `ss.studies`."""

    name = "studies"

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return a command for each study."""
        from stickslip.extensions.studies.commands.analogy import analogy
        from stickslip.extensions.studies.commands.compare import compare
        from stickslip.extensions.studies.commands.ensemble import ensemble

        return {"Questions that need many runs": (compare, analogy, ensemble)}

    def public(self) -> Mapping[str, str]:
        """Return the studies and the classes of their results."""
        home = "stickslip.extensions.studies"
        return {
            "studies.Analogy": f"{home}.analogy:Analogy",
            "studies.Comparison": f"{home}.compare:Comparison",
            "studies.Ensemble": f"{home}.ensemble:Ensemble",
            "studies.analogy": f"{home}.analogy:analogy",
            "studies.compare": f"{home}.compare:compare",
            "studies.ensemble": f"{home}.ensemble:ensemble",
        }


EXTENSION = StudiesExtension()
