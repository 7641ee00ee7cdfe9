"""`stickslip doctor`: look at the installation, and compare a short run with a closed form."""

from __future__ import annotations

import typer

from stickslip.cli.output.show import console, print_words, say
from stickslip.foundation.errors import InputError


def doctor() -> None:
    r"""Check this installation: versions, cache, extras, and a short run against a closed form.

    The self-test takes about a second; the first time it compiles what a run
    needs, which takes about half a minute, once. An extra that is not installed
    is no fault.

    \b
      stickslip doctor
      stickslip doctor > installation.txt    a file for a report

    Each fault is one line on standard error, with its cure.

    Exit code: 0 all is well, 1 something is broken.
    """
    from stickslip.cli.installation import Finding, engine, installation, self_test

    found: list[Finding] = []
    try:
        for part in (installation, engine, self_test):
            for one in part():
                found.append(one)  # noqa: PERF402  # what was found before an error is shown, too
            if any(one.value == "missing" for one in found):
                break
    except InputError as error:
        found.append(Finding("engine", "cannot run", str(error)))
    except ImportError as error:
        found.append(Finding("engine", "cannot be imported", f"{error}: pip install --force-reinstall stickslip"))
    screen = console()
    print_words(screen, ("", ""), [(one.name, one.value) for one in found])
    faults = [one.fault for one in found if one.fault]
    for fault in faults:
        typer.echo(f"stickslip: doctor: {fault}", err=True)
    say(screen, "" if faults else "\nAll is well.")
    raise typer.Exit(1 if faults else 0)
