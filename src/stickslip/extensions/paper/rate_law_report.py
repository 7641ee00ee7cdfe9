"""What the report and the page say of faults under the rate law: the tables of the stored study, its answer, and its figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.extensions.paper.cases import Runs, problem
from stickslip.extensions.paper.rate_law_faults import (
    CURVES,
    LAG,
    SHOWN_LOADS,
    SLOWER_THAN_UNIFORM,
    largest_load_of_pulses,
    numbers,
    stored,
)
from stickslip.figures.sheet import sheet
from stickslip.figures.style import BLUE, GREY, INK, LINE_COLOURS, VERMILLION, quantity, styled
from stickslip.foundation.arrays import Floats

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

ANSWER = (
    "The paper's rate law is ill-posed along a contact. If friction follows the slip rate with a lag, it is solved. The slab in 1D"
    " then slips in one pulse; along a fault in 2D and 3D that depends on the load outside of the nucleus. Below the lower fold of"
    " the set K slip heals by itself behind its front; far above it, it is a crack. In a window between, what has healed slips"
    " again, so that places see several pulses in one event. At low loads in 2D far places see two, too. The echo of a rigid driver"
    " arrests slip out of a nucleus before."
)
"""The answer to the paper's question under the rate law."""
LAG_OF_ROW = "lag [s] or distance [m]"
"""The column with the lag."""
LAGS = {"line": LAG, "plane": 2.0 * LAG}
"""The lags (s) of the runs in 2D and 3D."""
STATION = "16 km"
"""The station whose slip rates are drawn."""


def found_rows(lag: float | None = None, **wanted: str) -> list[dict[str, str]]:
    """Return stored rows whose columns have these values, and this lag (s) if it is given, those with more nodes later."""
    rows = [row for row in stored() if all(row[name] == value for name, value in wanted.items())]
    rows = [row for row in rows if lag is None or float(row[LAG_OF_ROW]) == lag]
    return sorted(rows, key=lambda row: int(row["nodes"]))


def chosen(lag: float | None = None, **wanted: str) -> list[dict[str, str]]:
    """Return the rows that `found_rows` finds; of each load, driver and lag the one with the most nodes."""
    best: dict[tuple[str, ...], dict[str, str]] = {}
    for row in found_rows(lag, **wanted):
        best[row["background [MPa]"], row["driver"], row[LAG_OF_ROW], row["ends [km]"]] = row
    return sorted(best.values(), key=lambda row: (row["driver"] == "rigid", float(row["background [MPa]"])))


def pulses_of_row(row: dict[str, str]) -> list[int]:
    """Return the numbers of pulses at the stations of a stored row."""
    return [len(value.split()) for name, value in row.items() if name.startswith("pulses,")]


def most_pulses(row: dict[str, str]) -> int:
    """Return the largest number of pulses at a station of a stored row."""
    return max(pulses_of_row(row))


def meshes(background: str) -> Floats:
    """Return the slip in the middle (m) of the stored runs in 2D at a background load (MPa), with 512, 1024 and 2048 nodes."""
    rows = found_rows(LAG, group="load", law="lag", shape="line", driver="none")
    return numbers([row for row in rows if row["background [MPa]"] == background], "slip in the middle [m]")


def loads_table() -> list[dict[str, str]]:
    """Return for readers how slip spreads in 2D and 3D at each background load."""
    return [
        {
            "fault": {"line": "2D", "plane": "3D"}[shape],
            "driver": {"none": "none", "rigid": "rigid, at h"}[row["driver"]],
            "background load": f"{row['background [MPa]']} MPa",
            "slip": row["mode"],
            "pulses at 0, 8, 16, 24 km": ", ".join(map(str, pulses_of_row(row))),
            "middle rests": f"{float(row['rest, 0 km [s]']):.2f} s" if row["rest, 0 km [s]"] else "no",
            "front, 16 to 24 km": f"{front_speed(row):.2f} c" if row["arrival, 24 km [s]"] else "stops",
            "nodes": row["nodes"] if shape == "line" else f"{row['nodes']} × {row['nodes']}",
        }
        for shape in ("line", "plane")
        for row in chosen(LAGS[shape], group="load", law="lag", shape=shape)
    ]


def front_speed(row: dict[str, str], wave_speed: float = 3500.0) -> float:
    """Return the speed of the front from 16 to 24 km, over the wave speed (m/s)."""
    return 8e3 / (float(row["arrival, 24 km [s]"]) - float(row["arrival, 16 km [s]"])) / wave_speed


def healing_speed(row: dict[str, str], wave_speed: float = 3500.0) -> float:
    """Return the speed of the healing front from the middle to 8 km, over the wave speed (m/s)."""
    return 8e3 / (float(row["rest, 8 km [s]"]) - float(row["rest, 0 km [s]"])) / wave_speed


def alone_table() -> list[dict[str, str]]:
    """Return for readers the pulses on faults that are loaded alike everywhere and locked beyond, under a rigid driver."""
    return [
        {
            "fault": "2D" if row["shape"] == "line" else "3D, disc",
            "L/h": f"{2.0 * float(row['ends [km]']) / 10.0:g}",
            "pulses in the middle": f"{pulses_of_row(row)[0]}",
            "pulses at 8 km": _times(row, "8 km") if float(row["ends [km]"]) > 8.0 else "",
            "pulses at 16 km": _times(row, "16 km") if float(row["ends [km]"]) > 16.0 else "",
            "middle rests": f"{float(row['rest, 0 km [s]']):.2f} s",
            "nodes": row["nodes"] if row["shape"] == "line" else f"{row['nodes']} × {row['nodes']}",
        }
        for row in sorted(chosen(group="alone"), key=lambda row: (row["shape"], float(row["ends [km]"])))
    ]


def _times(row: dict[str, str], place: str) -> str:
    return row[f"pulses, {place} [s]"].replace(" ", ", ") + " s"


def before_the_echo(row: dict[str, str]) -> int:
    """Return the largest number of pulses before 2h/c at a place of a row of `alone_table`."""
    trip = problem("fig6-slab").round_trip_time
    times = [row[f"pulses at {place}"].removesuffix(" s").split(", ") for place in ("8 km", "16 km")]
    return max(int(row["pulses in the middle"]), *(sum(float(one) < trip for one in some if one) for some in times))


def fronts_table() -> list[dict[str, str]]:
    """Return for readers what is left of the shock at the start of slip, 12 km from the middle, against the lag."""
    found = []
    for background in ("60", "75"):
        lag, fall, peak = fronts(background)
        found += [
            {
                "background load": f"{background} MPa",
                "lag": f"{lag[place]:g} s",
                "friction falls within": f"{fall[place]:.4f} s",
                "largest slip rate": f"{peak[place]:.2f} m/s",
            }
            for place in range(len(lag))[::-1]
        ]
    return found


def fronts(background: str) -> tuple[Floats, Floats, Floats]:
    """Return lags (s), how long friction falls behind the front (s), and largest slip rates (m/s), 12 km from the middle."""
    rows = [row for row in chosen(group="front") if row["background [MPa]"] == background]
    rows.sort(key=lambda row: float(row[LAG_OF_ROW]))
    return numbers(rows, LAG_OF_ROW), numbers(rows, "fall, 12 km [s]"), numbers(rows, "peak, 12 km [m/s]")


def rate_law_data(_: Runs) -> xr.Dataset:
    """Return what the figure shows: when the middle rests, slip rates at 16 km, and the width of the front against the lag."""
    import xarray as xr

    rows = chosen(LAG, group="load", law="lag", shape="line", driver="none")
    contents: dict[str, Any] = {
        "background": quantity("background", 1e6 * numbers(rows, "background [MPa]"), "background load", "tau0", "Pa"),
        "rest": quantity("background", numbers(rows, "rest, 0 km [s]"), "time until the middle rests", "t", "s"),
        "pulses": quantity("background", np.array([most_pulses(row) for row in rows], float), "most pulses at a place", "n", "1"),
    }
    for load in SHOWN_LOADS:
        path = CURVES.with_stem(f"{CURVES.stem}-{load:g}")
        times, rate = np.loadtxt(path, delimiter=",", skiprows=1).T
        contents[f"time_{load:g}"] = quantity(f"time_{load:g}", times, "time", "t", "s")
        contents[f"rate_{load:g}"] = quantity(f"time_{load:g}", rate, f"slip rate at {STATION}, {load:g} MPa", "v", "m s-1")
    for background in ("60", "75"):
        lag, fall, _largest = fronts(background)
        contents[f"lag_{background}"] = quantity(f"lag_{background}", lag, "lag", "T", "s")
        meaning = f"duration of the fall of friction at 12 km, {background} MPa"
        contents[f"fall_{background}"] = quantity(f"lag_{background}", fall, meaning, "t", "s")
    limits = {"lower_fold": largest_load_of_pulses(), "limit_of_cracks": largest_load_of_pulses(SLOWER_THAN_UNIFORM["line"])}
    return xr.Dataset(contents, attrs=limits)


@styled
def draw_rate_law(dataset: xr.Dataset) -> Figure:
    """Draw when the middle rests against the load, slip rates at one place, and the width of the front against the lag."""
    figure = sheet((7.2, 4.4))
    axes: Any = figure.subplot_mosaic("ABB;ACC;EDD", width_ratios=(1.0, 0.6, 0.6))
    left, load = axes["A"], dataset.background.values / 1e6
    rests = np.isfinite(dataset.rest.values)
    left.plot(load[rests], dataset.rest.values[rests], "o", color=BLUE, markersize=5, label="rests")
    left.plot(load[~rests], np.full(int((~rests).sum()), 16.0), "^", color=VERMILLION, markersize=6, label="slips on")
    for name, value in dataset.attrs.items():
        if name in ("lower_fold", "limit_of_cracks"):
            left.axvline(value / 1e6, color=GREY, linewidth=0.9, linestyle="--")
    left.set(xlabel="background load (MPa)", ylabel="middle rests (s)", ylim=(0.0, 17.0))
    left.legend(fontsize=7, loc="upper left")
    for panel, background, colour in zip((axes[key] for key in "BCD"), SHOWN_LOADS, (INK, BLUE, VERMILLION), strict=True):
        panel.plot(dataset[f"time_{background:g}"], dataset[f"rate_{background:g}"], color=colour, linewidth=1.0)
        panel.set(ylabel=f"{background:g} MPa\n(m/s)", xlim=(0.0, 16.0))
        panel.set_ylim(0.0, None)
        panel.tick_params(labelbottom=background == SHOWN_LOADS[-1])
    axes["D"].set_xlabel(f"time $t$ (s); slip rate at {STATION}")
    below = axes["E"]
    for name, colour in zip(("60", "75"), LINE_COLOURS, strict=False):
        lag, fall = dataset[f"lag_{name}"].values, dataset[f"fall_{name}"].values
        below.loglog(lag, fall, "o-", color=colour, markersize=4, label=f"{name} MPa")
    below.set(xlabel="lag (s)", ylabel="fall at front (s)")
    below.set_xticks([0.1, 0.2, 0.4, 0.8], ["0.1", "0.2", "0.4", "0.8"], minor=False)
    below.set_yticks([0.03, 0.1, 0.3], ["0.03", "0.1", "0.3"], minor=False)
    below.minorticks_off()
    below.legend(fontsize=7)
    return figure


def orders(values: Floats, lags: Floats) -> Floats:
    """Return the exponents of a power of the lag between neighbours."""
    return np.diff(np.log(values)) / np.diff(np.log(lags))
