"""`stickslip fit`: make a friction law from measured points, and a scenario with it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import Changes, Columns, FigureFile, complete_law, complete_table, complete_template, option
from stickslip.cli.output.files import FigureLook, Target, announce, check_targets, drawing, write_files
from stickslip.cli.output.show import console, print_sentences, print_words, say
from stickslip.foundation.errors import InputError, gathered

if TYPE_CHECKING:
    from stickslip.friction import Fit, Points, Smooth
    from stickslip.problem import Problem

MOST_JOINED = 2000
"""Largest number of points whose exact interpolation is searched for folds, to say how many there would be."""
DataFile = Annotated[
    str, typer.Argument(help="A CSV file with columns friction and slip, slip_rate or both.", autocompletion=complete_table)
]


def complete_fitted(incomplete: str) -> list[str]:
    """Return the names of laws that can be fitted to points, as far as they begin with what is typed."""
    from stickslip.extensions.inference.points.fit_search import template
    from stickslip.friction import LAWS

    found = []
    for name in complete_law(incomplete):
        try:
            template(LAWS[name])
        except InputError:
            continue
        found.append(name)
    return found


def fit(
    data: DataFile,
    *,
    law: Annotated[
        str | None, option("The law to fit; two names joined by + or * too.", "--law", "-l", autocompletion=complete_fitted)
    ] = None,
    smooth: Annotated[str | None, option("Smooth the points: auto (cross-validation), or a strength such as 1e-5.")] = None,
    monotone: Annotated[bool, typer.Option("--monotone", help="Smooth to a curve that only rises or only falls.")] = False,
    along: Annotated[str | None, option("slip or slip_rate: the one to smooth along, if the file has both.")] = None,
    fix: Annotated[list[str] | None, option('A parameter that is known: NAME=VALUE, as "alpha=10 s/m".')] = None,
    start: Annotated[list[str] | None, option("Where the search for a parameter begins: NAME=VALUE.")] = None,
    body: Annotated[
        str | None,
        typer.Option(
            help="The scenario that lends --out its body and loading: by default slab, or string for points that turn.",
            autocompletion=complete_template,
        ),
    ] = None,
    changes: Changes = None,
    column: Columns = None,
    normal_force: Annotated[
        str | None, option('Normal force of forces, as "100 N" (torque, stress: of these).', "--normal-force")
    ] = None,
    out: Annotated[Path | None, option("Write a scenario with the law (.toml).", "--out", "-o")] = None,
    figure: FigureFile = None,
    look: FigureLook,
) -> None:
    r"""Make a friction law from measured points.

    The file is a CSV with a heading over each column: friction (or mu), and
    slip (or u), slip_rate (or v), or both. Units belong in the headings:
    "v (mm/s)", "slip [mm]"; "v (rpm)" or "slip (deg)" make a law for a contact
    that turns. Other columns are ignored. Forces and torques need
    --normal-force. Negative slip rates are backward slip: if friction differs
    there, the law is one of both ways.

    Without --law and --smooth, every law that suits the points is fitted and
    compared: the smallest BIC fits best for its number of parameters. With
    --law the parameters are shown with their standard uncertainties and with
    what the points do not determine. --smooth draws a smooth curve through the
    points instead.

    --out writes a scenario that can be run as it is. It takes its body and
    loading from --body, with the numbers of --set: edit them.

    \b
      stickslip fit data.csv
      stickslip fit data.csv --law hyperbolic-rate --figure fit.png
      stickslip fit data.csv --law exponential-stribeck --fix viscosity=0
      stickslip fit data.csv --smooth auto --out mine.toml --body block \
        --set "body.normal_force=50 kN" --set "pull_rate=1 mm/s"
    """
    from stickslip import friction
    from stickslip.cli.overrides import typed_columns, typed_values
    from stickslip.foundation.headings import is_number
    from stickslip.friction import Points
    from stickslip.problem.scenarios import is_scenario_name

    if is_scenario_name(data):
        cure = "`stickslip infer SCENARIO DATA --free NAMES` follows a record with runs of a scenario"
        raise InputError(f"fit: {data} is a scenario, and points come first here: `stickslip fit DATA`; {cure}")
    check_targets(Target("--out", out, (".toml",)), Target("--figure", figure))
    look.check(figure)
    _check_options(law, smooth, monotone, along, {"--fix": fix, "--start": start})
    values = typed_values(changes or (), "fit: --set", '"body.normal_force=50 kN"')
    if values and out is None:
        raise InputError("fit: --set belongs to --out, which takes its body and loading from --body")
    if normal_force is not None and is_number(normal_force):
        cure = f'write --normal-force "{normal_force} N", of torques in N m, of stresses in Pa'
        raise InputError(f"fit: --normal-force has no unit, got {normal_force}: {cure}")
    points = Points.read(data, columns=typed_columns(column, "fit: --column"), normal_force=normal_force)
    body = body or ("string" if points.slips_in else "slab")
    if out is not None:
        from stickslip.problem.scenarios import with_law

        before = friction.Coulomb(0.6, 0.5)
        points.of_contact(before)
        with_law(body, before, ["before the work"], values)
    if law is not None:
        known = typed_values(fix or (), "fit: --fix", "static=0.6")
        result: Fit | Smooth = friction.fit(points, law, start=typed_values(start or (), "fit: --start", "static=0.6"), fixed=known)
    elif smooth is not None:
        result = friction.smooth(points, _strength(smooth), monotone=monotone, along=along)
    else:
        result = _best(points)
    _show_result(result)
    text = None if out is None else _scenario(result, body, data, values)
    if text is not None:
        from stickslip.problem.scenarios import read_scenario

        _show_uniqueness(result, read_scenario(text, str(out)).problem)
    announce(
        *write_files(
            (out, lambda path: _write_text(path, text or "")),
            (figure, drawing(lambda **place: _draw(result, **place), look)),
        )
    )
    if out is not None:
        typer.echo(f"edit [body], [loading] and [run] in it, then: stickslip check {out}; stickslip run {out}")


def _check_options(
    law: str | None, smooth: str | None, monotone: bool, along: str | None, given: dict[str, list[str] | None]
) -> None:
    """Refuse options that do not go together. Raises InputError."""
    if law is not None and smooth is not None:
        raise InputError("fit: --law and --smooth exclude each other: run the command twice")
    for name, wanted in (("--monotone", monotone), ("--along", along is not None)):
        if wanted and smooth is None:
            raise InputError(f"fit: {name} belongs to --smooth")
    for name, values in given.items():
        if values and law is None:
            raise InputError(f"fit: {name} belongs to --law")


def _strength(text: str) -> Any:
    """Return a typed strength as a number, or "auto". Raises InputError."""
    if text == "auto":
        return text
    try:
        return float(text)
    except ValueError:
        raise InputError(f"fit: --smooth must be auto or a number such as 1e-5, got {ascii(text)[:60]}") from None


def _scenario(result: Fit | Smooth, body: str, data: str, values: dict[str, Any]) -> str:
    """Return the text of a scenario with the law of a result, and with the result as comments at its head."""
    from stickslip.problem.scenarios import with_law

    rows = [f"  {name} = {value} {meaning}" for name, value, meaning in result.rows]
    return with_law(body, result.law, [f"{Path(data).name}: {result.title}", *rows, *result.notes], values)


def _write_text(path: Path, text: str) -> Path:
    from stickslip.foundation.atomic_write import write_atomically

    return write_atomically(path, lambda draft: draft.write_text(text, encoding="utf-8"))


def _draw(result: Fit | Smooth, **place: Any) -> object:
    from stickslip.extensions.inference.figures import measured

    return measured.draw_measured(measured.measured_data(result), **place)


def _show_result(result: Fit | Smooth) -> None:
    """Print the numbers of a fit or of a smooth curve, and what was noticed."""
    from stickslip.foundation.show import clean  # here and below, with numpy, which help does without

    screen = console()
    say(screen, clean(f"{result.points.name}: {result.title}"), style="bold")
    print_words(screen, ("", "value", "unit"), list(result.rows))
    print_sentences(screen, *result.points.notes, *result.notes)


def _best(points: Points) -> Fit:
    """Fit all laws that suit the points, print a comparison, and return the best fit. Raises InputError if there is none."""
    from stickslip import friction
    from stickslip.foundation.show import clean

    fits = friction.fit_each(points)
    if not fits:
        raise InputError(f"fit: no law can be fitted to these {len(points)} points: use --smooth")
    screen = console()
    say(screen, clean(f"{points.name}: {sum(map(len, points.ways))} points along {' and '.join(points.has)}"), style="bold")
    rows = []
    for one in fits:
        known = f"{len(one.uncertainty)}"
        noticed = "; ".join(one.notes[:1]) + (f" (and {len(one.notes) - 1} more)" if len(one.notes) > 1 else "")
        rows.append((one.fitted, known, f"{one.residual:.3g}", f"{one.bic - fits[0].bic:.1f}", noticed))
    print_words(screen, ("law", "parameters", "residual", "BIC above best", "noticed"), rows)
    print_sentences(
        screen,
        "a difference of BIC above 10 is decisive. The best of several wrong laws is wrong too: see what was noticed, and a figure",
    )
    return fits[0]


def _show_uniqueness(result: Fit | Smooth, problem: Problem) -> None:
    """Print whether the slip rate is unique under a law, and how many folds exact interpolation and the law have."""
    from stickslip.contact import uniqueness_of

    contact = uniqueness_of(problem)
    screen = console()
    print_sentences(screen, contact.summary.removesuffix("."))
    if contact.resistance is None or not problem.friction.depends_on_rate:
        return
    folds = len(contact.folds) + (0 if contact.backward is None else len(contact.backward.folds))
    joined = _folds_of_points(result.points, problem)
    before = "" if joined is None else f"{joined} with the points joined exactly, "
    print_sentences(screen, f"folds of the contact equation: {before}{folds} with this law")


def _folds_of_points(points: Points, problem: Problem) -> int | None:
    """Return the number of folds of the same problem with the points joined exactly, or None if they cannot be."""
    from stickslip.contact import uniqueness_of
    from stickslip.friction import FromTable

    if len(points) > MOST_JOINED or len(points.has) != 1:
        return None
    try:
        with gathered():
            return len(uniqueness_of(replace(problem, friction=FromTable(points))).folds)
    except InputError:
        return None
