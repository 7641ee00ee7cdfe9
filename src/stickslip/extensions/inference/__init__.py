"""From measurements to the parameters of a problem, with their uncertainty: from records of runs, and from points of a law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from stickslip.extension import Command, Extension

if TYPE_CHECKING:
    from stickslip.extensions.inference.beside import BesideRun as BesideRun
    from stickslip.extensions.inference.beside import RecordBeside
    from stickslip.foundation.record_files import RecordForm
    from stickslip.problem import Problem


class InferenceExtension(Extension):
    """The commands `fit` and `infer`, `ss.studies.infer`, `ss.friction.fit` and `ss.friction.smooth`."""

    name = "inference"

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the commands `fit` and `infer`."""
        from stickslip.extensions.inference.commands.fit import fit
        from stickslip.extensions.inference.commands.infer import infer

        return {"Measured friction": (fit, infer)}

    def forms(self) -> Sequence[RecordForm]:
        """Return the formats of LabVIEW (.lvm), LAS and universal files."""
        from stickslip.extensions.inference.record_forms import FORMS

        return FORMS

    def public(self) -> Mapping[str, str]:
        """Return what is known as a study, as a law through points, and as a figure of it."""
        home = "stickslip.extensions.inference"
        return {
            "figures.plot_fit": f"{home}.figures.measured:plot_fit",
            "friction.Fit": f"{home}.points.fit:Fit",
            "friction.Smooth": f"{home}.points.smooth:Smooth",
            "friction.fit": f"{home}.points.fit:fit",
            "friction.fit_each": f"{home}.points.fit:fit_each",
            "friction.smooth": f"{home}.points.smooth:smooth",
            "studies.Inference": f"{home}.inference:Inference",
            "studies.Record": f"{home}.record.record:Record",
            "studies.infer": f"{home}.infer:infer",
            "studies.ranking": f"{home}.inference:ranking",
        }


EXTENSION = InferenceExtension()


def record_beside(source: Any, sensor: str, problem: Problem, who: str, **given: Any) -> RecordBeside:
    """Return a record, as `Record.read` reads it, that is put beside runs of a problem: this is what other extensions may use.

    Raises InputError, which begins with `who` or with the name of the record.
    """
    from stickslip.extensions.inference.beside import RecordBeside
    from stickslip.extensions.inference.record.record import Record

    return RecordBeside.of(Record.read(source, **given), sensor, problem, who)
