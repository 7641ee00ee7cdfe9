"""Claim 23, on several pulses in 3D, from the stored studies of faults under both laws."""

from __future__ import annotations

import numpy as np

from stickslip.extensions.paper import planar
from stickslip.extensions.paper.cases import Runs
from stickslip.extensions.paper.claims.verdict import ClaimVerdict, Outcome, claim, each, judge, verdict
from stickslip.extensions.paper.rate_law_faults import SLOWER_THAN_UNIFORM, largest_load_of_pulses
from stickslip.extensions.paper.rate_law_report import LAGS, alone_table, before_the_echo, chosen, meshes, most_pulses


@claim(23, "Several slip velocity pulses during a sliding event are retained in 3D.")
def pulses_in_3d(_: Runs) -> ClaimVerdict:
    """Measure pulses under the slip law on discs, and under the rate law with a lag, whose stored runs have several grids."""
    slip = {f"L = {row['L/h']} h": int(row["in the middle until 2h/c"]) for row in planar.table() if row["fault"] == "3D, disc"}
    rate: dict[str, dict[str, int]] = {}
    for shape, where in (("line", "2D"), ("plane", "3D")):
        for driver, echo in (("none", "no echo"), ("rigid", "echo at 2h/c")):
            rows = chosen(LAGS[shape], group="load", law="lag", shape=shape, driver=driver)
            rate[f"{where}, {echo}"] = {f"{row['background [MPa]']} MPa": most_pulses(row) for row in rows}
    alike = {f"L = {row['L/h']} h": before_the_echo(row) for row in alone_table() if row["fault"] == "2D"}
    under_slip_law = max(slip.values()) > 1
    everywhere = under_slip_law and all(count > 1 for counts in rate.values() for count in counts.values())
    somewhere = under_slip_law or max(rate["3D, no echo"].values()) > 1
    why = (
        "Under the slip law a disc sees the pulses of 1D until waves from its edge arrive. Under the rate law alone the problem "
        "along a contact is ill-posed, and is refused. With a lag it is solved, and 1D has one pulse. Along a fault it depends on "
        "the load outside of the nucleus. Up to the lower fold of the set K slip heals by itself behind its front. Far above it "
        "a crack goes on slipping. Between, where (π/2)Z in 2D and 2Z in 3D take the place of Z, what has healed slips again, in "
        "several pulses in one event; in 3D one load shows this. At low loads in 2D, 50 and 55 MPa, far places see two pulses, "
        "while the middle sees one. The echo of a rigid driver ends slip out of a nucleus before that. Where a long line is "
        "loaded alike everywhere, places off the middle have three pulses before the echo. All runs are stored."
    )
    return verdict(
        Outcome.QUALIFIED if somewhere and not everywhere else judge(everywhere),
        "slip law: on faults long enough; rate law with a lag: in a window of loads, and at low ones in 2D, without the echo",
        why,
        *each("pulses until 2h/c, slip law, disc", slip),
        *[number for where, counts in rate.items() for number in each(f"most pulses at a place, rate law, {where}", counts)],
        *each("most pulses at a place until 2h/c, rate law, lines loaded alike", alike),
        ("lower fold of K", largest_load_of_pulses(), "Pa"),
        ("the same for the middle of a crack in 2D, (π/2)Z for Z", largest_load_of_pulses(SLOWER_THAN_UNIFORM["line"]), "Pa"),
        ("the same for the middle of a round crack, 2Z for Z", largest_load_of_pulses(SLOWER_THAN_UNIFORM["plane"]), "Pa"),
        ("difference of slip between the two finest grids, 60 MPa", float(np.abs(np.diff(meshes("60")))[-1]), "m"),
    )
