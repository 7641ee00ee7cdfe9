"""Figures 1 to 7 of the paper, and two on the question on which it closes: runs, data, drawing function and caption of each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stickslip.contact import uniqueness_of
from stickslip.extensions.paper import planar, rate_law_report
from stickslip.extensions.paper.cases import Runs, problem, typed
from stickslip.extensions.paper.figures import comparison, resistance, systems
from stickslip.friction import HyperbolicRate, SinusoidalSlip

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

SHOWN = 7.0
"""Duration (s) shown by Figs 5 to 7: somewhat more than one round trip of the waves, 5.714 s."""


@dataclass(frozen=True)
class Plate:
    """One figure: functions that make and draw its data, and the caption below it."""

    number: int
    title: str
    caption: str
    data: Callable[[Runs], xr.Dataset]
    draw: Callable[[xr.Dataset], Figure]


def _laws(_: Runs) -> xr.Dataset:
    slip = [typed(problem(f"fig5-slab-{name}").friction, SinusoidalSlip) for name in ("printed", "reconstructed")]
    rate = [typed(problem(name).friction, HyperbolicRate) for name in ("fig6-slab", "fig7-slab-critical")]
    slip_laws = {rf"$\omega$ = {law.wavenumber:g} m$^{{-1}}$": law for law in slip}
    return systems.laws_data(slip_laws, {rf"$\alpha$ = {law.alpha:g} s/m": law for law in rate}, 1.3, 10.0)


def _sets(_: Runs) -> xr.Dataset:
    irregular = problem("fig6-slab")
    alpha = 0.5 * (uniqueness_of(irregular).critical_value or 0.0)
    cases = {"regular": irregular.parameters["alpha"].put(alpha), "irregular": irregular}
    titles = {name: rf"{name.capitalize()}, $\alpha$ = {case.parameters['alpha'].value:g} s/m" for name, case in cases.items()}
    return resistance.resistance_data(cases, 6.0, titles)


def _side_by_side(block: str, slab: str, title: str) -> Callable[[Runs], xr.Dataset]:
    """Return the function that runs a block and a slab; `title` follows their names."""

    def compared(runs: Runs) -> xr.Dataset:
        solutions = {"block": runs(problem(block), SHOWN), "slab": runs(problem(slab), SHOWN)}
        titles = {"block": f"Block, {title}", "slab": f"Slab, {title}"}
        return comparison.comparison_data(solutions, SHOWN, titles)

    return compared


PLATES = (
    Plate(
        1,
        "The two systems",
        "A rigid block pulled through a spring, and an elastic slab of infinite extent pulled at its far side, both on a "
        "frictional contact. Not to scale.",
        lambda _: systems.systems_data(problem("fig6-block-printed"), problem("fig6-slab")),
        systems.draw_systems,
    ),
    Plate(
        2,
        "The friction laws",
        "Left: the sinusoidal slip law (14), as printed and as reconstructed. Right: the hyperbolic rate law (15) of Figs 6 and 7.",
        _laws,
        systems.draw_laws,
    ),
    Plate(
        3,
        "The set K",
        "Every pair of slip rate and load that solves the contact equation. Regular: one slip rate for each load. "
        "Irregular: three between the folds A and C. Dotted: the jumps of the rule of perfect delay.",
        _sets,
        resistance.draw_resistance,
    ),
    Plate(
        4,
        "The rule of perfect delay, walked by one run",
        "A slab under a dead load, pushed so that the load rises and falls within one round trip. Left: its path over the "
        "set K (grey); the two ways are drawn a little apart where they share a branch. Right: the same run in time.",
        lambda runs: resistance.loop_data(runs.case("fig4-loop")),
        resistance.draw_hysteresis,
    ),
    Plate(
        5,
        "Block and slab under the slip law",
        "Reconstructed: ω = 50 /m and 1 mm added to D0; the block's stiffness as printed. The block slips once; the slab "
        "slips in pulses until the reflected wave arrests it at 2h/c.",
        _side_by_side("fig5-block-reconstructed-omega", "fig5-slab-reconstructed", "slip law"),
        comparison.draw_comparison,
    ),
    Plate(
        6,
        "Block and slab under the rate law, α = 1 s/m",
        "The slab as printed; the block with K = G × 10³ m (as printed, K = G × 10⁴ m, it has no macroscopic event). The "
        "block's slip rate is continuous, the slab's jumps at 0+ and at 2h/c.",
        _side_by_side("fig6-block-reconstructed", "fig6-slab", r"$\alpha$ = 1 s/m"),
        comparison.draw_comparison,
    ),
    Plate(
        7,
        "Block and slab under the rate law just above the critical value, α = αc + 10⁻⁶ s/m",
        "The slab as printed: two tiny shocks with smooth acceleration between them. The block with K = G × 10³ m and the "
        "same friction only follows the driver in tiny steps, four orders slower.",
        _side_by_side("fig7-block-critical", "fig7-slab-critical", r"$\alpha_c$ + 10$^{-6}$ s/m"),
        comparison.draw_comparison,
    ),
    Plate(
        8,
        "Beyond the paper: several pulses in 2D and 3D",
        "Left: pulses in the middle of faults of length L until the echo returns at 2h/c (filled) and until 4h/c (open). "
        "Right: slip rate in the middle for L = 2 h; the dotted line is the time at which waves from the ends arrive. "
        "The curve in 3D and the points on the left are stored, that in 2D is computed now if JAX is there.",
        planar.planes_data,
        planar.draw_planes,
    ),
    Plate(
        9,
        "Beyond the paper: the rate law along a fault, with a lag",
        "2D, no echo. Above: when the middle of a fault first rests, against the load outside of its nucleus; dashed, the lower "
        "fold of the set K, and the same with (π/2)Z for Z. Below: how long friction falls behind the front, 12 km from "
        "the middle, against the lag. Right: slip rate 16 km from the middle, a pulse at 60 MPa, several at 70, a crack at 75.",
        rate_law_report.rate_law_data,
        rate_law_report.draw_rate_law,
    ),
)
"""All figures, those of the paper first and in its order."""
