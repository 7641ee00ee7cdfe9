"""Draw docs/figures/scheme-verdicts.png and print its table: the rule that each scheme follows, by mesh and Courant number.

python docs/scheme_verdicts.py

The problem is the loop of Fig. 4. Below the schemes stand two regularisations of the exact contact, each as large as a grid makes
it: the contact mass rho dx/2, and the lag dx/(2c) of friction, which is that mass divided by the impedance.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib import pyplot as plt
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

import stickslip as ss
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.regularisations import LAB
from stickslip.extensions.schemes.run import SCHEMES, run_scheme
from stickslip.extensions.schemes.verdict import RulePaths, exact_runs
from stickslip.figures.style import LINE_COLOURS

FIGURE = Path(__file__).with_name("figures") / "scheme-verdicts.png"
CELLS = (25, 50, 100, 200, 400, 800)
SEARCHES = ("stick-first", "continue")
RULES = ("perfect-delay", "minimal", "maxwell", "maximal", "none", "several")
COLOURS = (*LINE_COLOURS[:4], "#e4e4e4", "#a0a0a0")
LETTERS = dict(zip(RULES, "DmMx-?", strict=True))
KINDS = ("contact-mass", "lag")
DURATION = 5.7


def rows_of_schemes() -> list[tuple[str, float]]:
    """Return each scheme with its own Courant number, and with half of it where it has a choice."""
    fixed = ("characteristics", "central-differences-cfl1")
    return [
        (name, scheme.courant * share) for name, scheme in SCHEMES.items() for share in ((1.0,) if name in fixed else (1.0, 0.5))
    ]


def verdicts(search: str, meshes: tuple[int, ...] = CELLS) -> dict[str, str]:
    """Return a letter of LETTERS for each mesh: the rule that each scheme, and each regularisation, follows."""
    problem = ss.load_scenario("fig4-loop").problem
    paths = RulePaths(exact_runs(problem, DURATION, 1e-10, lambda text: None), DURATION)
    found: dict[str, list[Series]] = {}
    for name, courant in rows_of_schemes():
        runs = [run_scheme(problem, DURATION, SCHEMES[name], cells, search=search, courant=courant) for cells in meshes]
        found[f"{name} {courant:g}"] = runs
    found |= {kind: [run_scheme(problem, DURATION, LAB[kind], cells) for cells in meshes] for kind in KINDS}
    return {label: "".join(LETTERS.get(paths.followed(run), LETTERS["several"]) for run in runs) for label, runs in found.items()}


def main() -> None:
    """Measure, print a table for the page, and draw."""
    both = {search: verdicts(search) for search in SEARCHES}
    labels = list(both[SEARCHES[0]])
    for label in labels:
        print(f"| {label} | " + " | ".join(f"`{both[search][label]}`" for search in SEARCHES) + " |")
    figure, panels = plt.subplots(1, 2, figsize=(8.0, 5.6), sharey=True, layout="constrained")
    letters = list(LETTERS.values())
    for panel, search in zip(panels, SEARCHES, strict=True):
        grid = np.array([[letters.index(letter) for letter in both[search][label]] for label in labels])
        panel.imshow(grid, cmap=ListedColormap(COLOURS), vmin=-0.5, vmax=len(RULES) - 0.5, aspect="auto")
        panel.set(xticks=range(len(CELLS)), xticklabels=CELLS, xlabel="cells", title=f"search: {search}")
        panel.set_yticks(range(len(labels)), labels, fontsize=8)
        panel.hlines(np.arange(len(labels)) - 0.5, -0.5, len(CELLS) - 0.5, color="white", linewidth=1.0)
    keys = [Patch(color=colour, label=rule) for rule, colour in zip(RULES, COLOURS, strict=True)]
    figure.legend(handles=keys, loc="outside lower center", ncols=6, fontsize=8, frameon=False)
    figure.savefig(FIGURE, dpi=150)


if __name__ == "__main__":
    main()
