"""`stickslip regularise`: find the selection rule to which regularised contacts converge."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from stickslip.cli.names import complete_regularisation, complete_scenario
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario
    from stickslip.studies.regularise import Regularisation


def regularise(
    scenario: Annotated[str, typer.Argument(help="A TOML file, or a bundled name.", autocompletion=complete_scenario)],
    by: Annotated[
        str,
        typer.Option(help="Kind of regularisation: contact-mass, lag or direct-effect.", autocompletion=complete_regularisation),
    ] = "contact-mass",
    largest: Annotated[str | None, typer.Option(help="Largest size: s, or with a unit; default R/30.", show_default=False)] = None,
    smallest: Annotated[str | None, typer.Option(help="Smallest size; default R/491520.", show_default=False)] = None,
    count: Annotated[int, typer.Option(help="How many sizes, evenly spaced in their logarithm.")] = 8,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", help="Save the table, a row for each size (.csv).", show_default=False)
    ] = None,
    figure: Annotated[
        Path | None, typer.Option("--figure", "-f", help="Save a figure (.png, .pdf or .svg).", show_default=False)
    ] = None,
    duration: Annotated[
        str | None, typer.Option(help='Override the duration: s, or with a unit ("480 year").', show_default=False)
    ] = None,
    rtol: Annotated[float | None, typer.Option(help="Override the relative tolerance.", show_default=False)] = None,
) -> None:
    """Find which selection rule physics chooses: compare runs with ever less inertia or lag at the contact with every rule.

    If several slip rates solve the contact equation, a rule picks one. A
    little physics makes the slip rate unique: a contact mass of Z size, or
    friction that lags behind the slip rate by the time `size`, with or without
    a direct effect (variation of mu * size / R). The size shrinks, and the runs
    are compared with the exact answer of each rule. The result is the rule to
    which they converge, if any, and the power of the size with which they do.

    \b
      stickslip regularise fig4-loop
      stickslip regularise fig4-loop --by lag --figure lag.png --out lag.csv
      stickslip regularise mine.toml --largest "0.1 s" --smallest "1 us"

    Exit code: 0 done, 2 unusable input, 130 interrupted.
    """
    from stickslip.cli.output.files import check_target

    for path, option, suffixes in ((out, "--out", (".csv",)), (figure, "--figure", (".png", ".pdf", ".svg"))):
        if path is not None:
            check_target(path, option, suffixes)
    chosen = _adjusted(scenario, duration, rtol)
    study = _study(chosen, by, _sizes(chosen, largest, smallest, count))
    _show(chosen, study)
    for line in _save(study, out, figure):
        typer.echo(line)


def _adjusted(name: str, duration: str | None, rtol: float | None) -> Scenario:
    from stickslip.scenarios.scenario import load_scenario
    from stickslip.scenarios.schema import check_rtol, read_duration

    loaded = load_scenario(name)
    if duration is not None:
        loaded = replace(loaded, duration=read_duration(duration, "regularise", "--duration"))
    if rtol is not None:
        loaded = replace(loaded, rtol=check_rtol(rtol, "regularise", "--rtol"))
    return loaded


def _sizes(scenario: Scenario, largest: str | None, smallest: str | None, count: int) -> list[float]:
    """Return the sizes (s) that were typed, evenly spaced in their logarithm. Raises InputError."""
    from stickslip.scenarios.schema import read_duration
    from stickslip.studies.regularisations import check_massless
    from stickslip.studies.regularise import default_sizes

    usual = default_sizes(check_massless(scenario.problem).two_way_time)
    first = usual[0] if largest is None else read_duration(largest, "regularise", "--largest")
    last = usual[-1] if smallest is None else read_duration(smallest, "regularise", "--smallest")
    if not last < first:
        raise InputError(f"regularise: --smallest must be less than --largest, got {last:g} s and {first:g} s")
    if not 3 <= count <= 100:
        raise InputError(f"regularise: --count must lie between 3 and 100, got {count}")
    return [first * (last / first) ** (k / (count - 1)) for k in range(count)]


def _study(scenario: Scenario, by: str, sizes: list[float]) -> Regularisation:
    from stickslip.cli.output.show import progress_to
    from stickslip.studies.regularise import regularise as study

    with progress_to(f"{scenario.name}:") as report:
        return study(scenario.problem, scenario.duration, by, sizes, rtol=scenario.rtol, progress=report)


def _show(scenario: Scenario, study: Regularisation) -> None:
    from stickslip.cli.output.show import clean, console, number, table
    from stickslip.studies.regularisations import kind_of

    screen, kind = console(), kind_of(study.by)
    screen.print(clean(scenario.title or scenario.name), style="bold")
    screen.print(f"{kind.title}, {len(study.sizes)} sizes; mean |slip difference| from the exact answer of each rule")
    screen.print(f"(change: difference from the previous size; order: of the difference from {study.target})\n")
    rules = ["\n".join(group) + "\nm" for group in study.groups]
    ends = ("change\nm", "\norder", "\npieces", "computed\nms")
    shown = table("size\ns", f"{kind.parameter}\n{kind.unit}", *rules, *ends, numbers=True)
    order = study.local_orders(study.target)
    for i, size in enumerate(study.sizes.tolist()):
        errors = [number(float(study.errors(group[0])[i]), 4) for group in study.groups]
        run = (number(float(study.changes[i]), 3), _order(float(order[i])), str(len(study.runs[i].history)))
        own = number(kind.value(study.problem, size), 4)
        shown.add_row(number(size, 4), own, *errors, *run, f"{1e3 * study.seconds[i]:.2f}")
    screen.print(shown)
    _show_jumps(study)
    for line in (study.stopped, study.verdict.text):
        if line:
            screen.print(f"\n{line[0].upper()}{line[1:]}.")


def _show_jumps(study: Regularisation) -> None:
    from stickslip.cli.output.show import console, number, table

    if study.jumps.empty:
        return
    screen, delays = console(), study.delays
    screen.print(f"\njumps under {study.target}, and how much later they come")
    ends = (0, -1)
    headings = [f"delay at\n{number(float(study.sizes[i]), 3)} s" for i in ends]
    shown = table("time\ns", "\ncause", "rate before\nm/s", "rate after\nm/s", *headings, "\norder", "\nexpected", numbers=True)
    for j, jump in enumerate(study.jumps.to_dict("records")):
        late = [number(float(delays[i, j]), 4) for i in ends]
        rates = (number(jump["rate_before"], 6), number(jump["rate_after"], 6))
        shown.add_row(number(jump["time"], 8), jump["cause"], *rates, *late, _order(float(jump["order"])), str(jump["expected"]))
    screen.print(shown)


def _order(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"


def _save(study: Regularisation, out: Path | None, figure: Path | None) -> list[str]:
    from stickslip.foundation.atomic_write import write_atomically

    written = []
    if out is not None:
        table = study.table
        write_atomically(out, lambda draft: table.to_csv(draft, index=False, lineterminator="\n"))
        written.append(f"written: {out}")
    if figure is not None:
        write_atomically(figure, study.plot().savefig)
        written.append(f"written: {figure}")
    return written
