"""Figures of chains draw what the run says: bars from onset to arrest, events, energies that balance, and a slope."""

from __future__ import annotations

from functools import cache
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import pyplot as plt
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.extensions.chains.changes_between import changes_between, slips_of, window_of
from stickslip.extensions.chains.figures.energy import energies_at_events
from stickslip.extensions.chains.plots import ChainPlots
from stickslip.extensions.chains.run import ChainRun
from stickslip.extensions.chains.solver import solve_chain

mpl.use("Agg")


@cache
def run(keep: Any = "changes", damping: float = 0.0) -> ChainRun:
    """Return the run of ten blocks, from a rough start."""
    law = ss.friction.Coulomb(static=1.0, dynamic=0.7)
    start = -np.random.default_rng(1).uniform(0.0, 0.5, 10)
    return solve_chain(ss.Chain(law, 10, 1.0, 10.0, 1.0, 1.0, 1e-3, initial_slip=start, damping=damping), 1000.0, keep=keep)


def test_slips_are_those_between_changes() -> None:
    found = run()
    slips = slips_of(found.changes, found.slip)
    total = np.zeros(10)
    np.add.at(total, slips.block, slips.slip)
    start = found.chain.values("initial_slip")
    assert total == pytest.approx(found.slip - start, rel=0.0, abs=1e-12)
    assert (slips.arrest > slips.onset).all()
    assert not np.isnan(slips.arrest).any()


def test_slip_that_goes_on_is_counted_to_the_end() -> None:
    found = run()
    n = int(found.events["moment"].argmax())
    middle = float(found.events["time"][n] + 0.5 * found.events["duration"][n])
    cut = solve_chain(found.chain, middle, keep="changes")
    slips = slips_of(cut.changes, cut.slip)
    assert np.isnan(slips.arrest).any()
    total = np.zeros(10)
    np.add.at(total, slips.block, slips.slip)
    assert total == pytest.approx(cut.slip - found.chain.values("initial_slip"), rel=0.0, abs=1e-12)


def test_changes_that_were_not_kept_are_found_again() -> None:
    kept, without = run(), run(keep="catalogue")
    first, last, event = window_of(without, None, None, None)
    assert event == int(np.abs(kept.events["moment"]).argmax())
    again = changes_between(without, first, last)
    assert len(again) > 10
    assert again.tolist() == changes_between(kept, first, last).tolist()


def test_a_bar_for_each_slip_of_the_largest_event() -> None:
    found = run()
    figure = ChainPlots(found).rupture()
    bars, slip = figure.axes[:2]
    first, last, _ = window_of(found, None, None, None)
    slips = slips_of(changes_between(found, first, last), found.slip)
    (collection,) = bars.collections
    assert len(collection.get_paths()) == len(slips.block)
    widths = [float(np.ptp(path.vertices[:, 0])) for path in collection.get_paths()]
    assert widths == pytest.approx(slips.arrest - slips.onset, rel=1e-9, abs=2e-3 * (last - first))
    assert len(slip.patches) == 10
    plt.close("all")


def test_energies_between_events_are_what_the_driver_gave() -> None:
    found = energies_at_events(run(damping=0.05))
    total = found["springs"] + found["heat"] + found["dashpots"] - found["driver"]
    assert total == pytest.approx(np.full(len(total), total[0]), rel=0.0, abs=1e-10)
    assert (np.diff(found["heat"]) >= 0.0).all()
    assert found["dashpots"][-1] > 0.0
    # the driver pulls with the sum of its springs: a straight line between the ends of rest is bent by at most one event
    assert (np.diff(found["time"]) >= 0.0).all()


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", ["catalogue", "rupture", "energy", "frequency"])
def test_every_figure_is_drawn_where_it_is_asked_for(name: str) -> None:
    plots = ChainPlots(run())
    given = {"completeness": -1.0} if name == "frequency" else {}
    figure = getattr(plots, name)(size="12 x 8 cm", dpi=50, **given)
    assert isinstance(figure, Figure)
    assert figure.get_size_inches() == pytest.approx([12 / 2.54, 8 / 2.54], rel=1e-12, abs=0.0)
    figure.canvas.draw()
    inside: Any = Figure()
    assert getattr(plots, name)(figure=inside, **given) is inside
    plt.close("all")


def test_the_default_is_the_catalogue() -> None:
    figure = ChainPlots(run())()
    (stems,) = figure.axes[0].collections
    assert len(stems.get_segments()) == len(run().events)
    assert figure.axes[1].lines[0].get_ydata() == pytest.approx(run().events["size"], rel=0.0, abs=0.0)
    plt.close("all")


REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"event": 1000}, "plot.rupture: event must be a whole number from 0 to"),
    ({"event": 1, "start": 0.0}, "plot.rupture: give an event, or start and end, not both"),
    ({"start": 5.0, "end": 4.0}, "plot.rupture: start and end must ascend from 0 to 1000 s, got 5 and 4"),
]


@pytest.mark.parametrize(("given", "message"), REFUSED)
def test_windows_that_are_not_there_are_refused_in_one_line(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError) as error:
        ChainPlots(run()).rupture(**given)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


def test_a_run_without_events_says_so() -> None:
    law = ss.friction.Coulomb(static=1.0, dynamic=0.7)
    quiet = solve_chain(ss.Chain(law, 3, 1.0, 10.0, 1.0, 1.0, 1e-3), 10.0)
    for draw in (ChainPlots(quiet).catalogue, ChainPlots(quiet).rupture):
        with pytest.raises(ss.InputError, match=r"no .*event"):
            draw()
