"""Examine a scenario with a [chain] without running it: its numbers, its frequencies, its first event, steady sliding."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.extensions.chains.before_run import ChainBeforeRun
from stickslip.extensions.chains.couplings import is_sparse
from stickslip.extensions.chains.drawn import DISTRIBUTIONS, Drawn
from stickslip.extensions.chains.per_block import of_blocks
from stickslip.foundation.quantities import Quantity, fields_of
from stickslip.foundation.show import brief, number, with_unit

if TYPE_CHECKING:
    from stickslip.extensions.chains.chain import Chain
    from stickslip.problem.scenarios import Scenario

STIFF, SOFT = 100.0, 0.01
"""Springs between blocks beyond these shares of those to the driver make a chain nearly one block, or nearly many of their own."""
MANY_ONSETS = 1_000_000
"""From so many onsets on a run takes more than seconds."""


class ChainExamination:
    """The findings about a chain: `numbers` and `findings`, as `stickslip check` shows them."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = scenario
        self.chain: Chain = scenario.to_solve
        self.before = ChainBeforeRun(self.chain)

    def numbers(self) -> Iterator[tuple[str, ...]]:
        """Yield name, value and meaning of each number below the name of its table alone."""
        chain = self.chain
        law = self.scenario.problem.friction
        yield ("[friction]",)
        yield "kind", law.kind, ""
        for name, (declared, _) in fields_of(type(law)).items():
            if isinstance(declared, Quantity) and (value := getattr(law, name)) is not None:
                yield name, with_unit(value, declared.unit), declared.meaning
        yield ("[chain]",)
        yield "blocks", " by ".join(map(str, chain.shape)), "number of blocks" if len(chain.shape) == 1 else "rows and columns"
        for name, (of, _) in of_blocks().items():
            yield name, _shown(getattr(chain, name), of), of.meaning
        yield "pull_rate", with_unit(chain.pull_rate, "m/s"), "velocity V of the driver"
        yield "ends", chain.ends, "what the outer blocks are tied to"
        yield "direction", chain.direction, "where blocks may slip to"
        yield ("[run]",)
        yield "duration", with_unit(self.scenario.duration, "s"), "how long to simulate"

    def findings(self) -> Iterator[tuple[str, str]]:
        """Yield the name and the text of each finding."""
        low, high, are_bounds = self.before.frequencies
        within = "within " if are_bounds else ""
        yield "frequencies", f"{within}{number(low, 4)} to {number(high, 4)} rad/s where all blocks move{_periods(low, high)}"
        if self.before.wave_speed > 0.0:
            seconds = self.chain.count / self.before.wave_speed
            yield "waves", f"{number(self.before.wave_speed, 4)} blocks a second, {brief(seconds, 's')} from end to end"
        yield "first event", self._first()
        yield "steady sliding", self._steady()
        yield from self._size()
        for hint in self._hints():
            yield "hint", hint

    def _first(self) -> str:
        first = self.before.first
        if first is None:
            return "none: no block is ever loaded to its strength"
        others = f", with {first.at_once - 1} others at the same time" if first.at_once > 1 else ""
        when = "at once" if first.time == 0.0 else f"at {number(first.time, 9)} s"
        later = ", after the run has ended" if first.time > self.scenario.duration else ""
        return f"block {first.block} slips {'forward' if first.direction > 0 else 'backward'} {when}{others}{later}"

    def _steady(self) -> str:
        before, rate = self.before, brief(float(self.chain.pull_rate), "m/s")
        if float(self.chain.pull_rate) == 0.0:
            return "none: the driver rests"
        if not before.has_steady_sliding:
            return f"none: friction changes with slip, so that the chain does not slide at {rate} for ever"
        if before.is_stable is None:
            return f"at {rate}: it is not known whether it is stable, where friction of some blocks falls with the slip rate"
        if before.is_stable:
            kept = "fade" if (before.falls > 0.0).all() else "stay as small as they are, or fade"
            return f"at {rate} it is stable: disturbances {kept}, and a chain that slips everywhere does not stop by itself"
        grows = "" if math.isnan(before.growth) else f": disturbances grow by e within {brief(1.0 / before.growth, 's')}"
        return f"at {rate} it is unstable{grows}"

    def _size(self) -> Iterator[tuple[str, str]]:
        """Say how many onsets a run may have: a block that slips alone passes the middle between its ends by as much again."""
        before, chain = self.before, self.chain
        laws, which = chain.laws
        far = np.array([float(one.static_coefficient(0.0)) - one.range()[0] for one in laws])[which] * before.normal
        held = before.springs.diagonal()
        with np.errstate(divide="ignore", invalid="ignore"):
            slips = np.where((far > 0.0) & (held > 0.0), 2.0 * far / held, math.inf)
        driven = abs(float(chain.pull_rate)) * self.scenario.duration
        most = float(np.sum(np.where(before.pull > 0.0, driven / slips, 0.0)))
        if driven > 0.0 and most >= 1.0:
            takes = ", a few microseconds each and for each block that moves" if most > MANY_ONSETS else ""
            smallest = brief(float(slips.min()), "m")
            yield "size", f"a block that slips alone slips {smallest} or more: at most some {_rounded(most)} onsets{takes}"

    def _hints(self) -> Iterator[str]:
        chain, pull = self.chain, float(self.before.pull.mean())
        if len(chain.shape) > 1 or is_sparse(chain.coupling) or chain.count == 1 or not pull > 0.0:
            return
        coupling = float(np.mean(chain.coupling))
        across = coupling * (math.pi / chain.count) ** 2
        if across > STIFF * pull:
            yield (
                f"the springs between blocks are so stiff that the chain is nearly one block (kc (pi/n)^2 ="
                f" {number(across, 3)} N/m, kp = {number(pull, 3)} N/m)"
            )
        elif 4.0 * coupling < SOFT * pull:
            yield f"the springs between blocks are so soft that these are nearly {chain.count} blocks of their own"


def _rounded(count: float) -> str:
    """Return a large number with two digits that count, written out up to a million."""
    return f"{count:.2g}" if count > MANY_ONSETS else f"{float(f'{count:.2g}'):.0f}"


def _periods(low: float, high: float) -> str:
    """Return the periods of frequencies in words."""
    if not high > 0.0:
        return ""
    longest = f" to {brief(2.0 * math.pi / low, 's')}" if low > 0.0 else ", and one way to move without any spring"
    return f" (periods of {brief(2.0 * math.pi / high, 's')}{longest})"


def _shown(value: Any, of: Quantity) -> str:
    """Return a number of the blocks in words."""
    if isinstance(value, Drawn):
        has_unit = DISTRIBUTIONS[value.distribution].has_unit
        told = (with_unit(one, of.unit) if unit else number(one) for one, unit in zip(value.numbers, has_unit, strict=True))
        return f"{value.distribution} ({', '.join(told)}), seed {value.seed}"
    if not isinstance(value, np.ndarray | tuple):
        return with_unit(value, of.unit)
    many = np.asarray(value, float)
    low, high = (with_unit(float(one), of.unit) for one in (many.min(), many.max()))
    return low if low == high else f"{low} to {high}"
