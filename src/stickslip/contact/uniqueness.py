"""Uniqueness of the slip rate: number of solutions of the contact equation, its folds, and the jumps of the selection rule.

Source: Campillo et al. 1996, section 3: the set K of Fig. 3, the terms regular and irregular, and the jumps of Fig. 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.contact.both_ways import of_both_ways
from stickslip.contact.branches import branches_of, rates_at, resistance
from stickslip.contact.critical import critical_normal_stress, nearest_critical
from stickslip.contact.folds import Certificate, Fold, Verdict, sentence
from stickslip.contact.lowest_slope import critical_stress_between
from stickslip.contact.regime import Regime, named_regime, proof_of, window_of
from stickslip.contact.rules.loop import Jump, Loop, jumps_of, loop_of
from stickslip.contact.rules.selection import table_of
from stickslip.contact.slopes import FASTEST_BOUNDED
from stickslip.contact.uniqueness_in_words import (
    INERTIA,
    MOST_SHOWN,
    STATE,
    STATE_FALLS,
    WITH_DASHPOT,
    fold_lines,
    regime_lines,
    said_of_pressing,
    summary_of,
)
from stickslip.foundation.arguments import NamesAttributes, for_users
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantities_of
from stickslip.foundation.show import ShownAsTable
from stickslip.friction.law import rises_with_rate
from stickslip.problem import SELECTION_RULES, Branch, Plateau, Problem, Resistance, in_given_units, normal_name
from stickslip.problem.scenarios import read_problem

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stickslip.foundation.place import Place
    from stickslip.problem.scenarios import Scenario

MOST_LEFT = 16
"""If there is no end of folds, only the jumps of this many branches are worked out."""


@dataclass(frozen=True, repr=False)
class Uniqueness(NamesAttributes, ShownAsTable):
    """The result of `stickslip.uniqueness`; `print` shows it in sentences.

    Loads are in Pa and slip rates in m/s, all for forward slip; backward slip is the mirror image, or `backward` says otherwise.
    Then `regime` and the critical values are those of the direction that is less certain, and `folds` are those forwards.
    """

    regime: Regime
    """regular: one slip rate at every load. irregular: several slip rates at loads between the folds. continuum: all slip rates of
    an interval at one load (there may be folds besides)."""
    rule: str
    summary: str
    critical_parameter: str | None = None
    """Name of the parameter that has a critical value, as `critical_value` takes it: the one that the law names, otherwise the
    normal stress."""
    critical_value: float | None = None
    """Value of that parameter where the regime changes, in SI units."""
    critical_unit: str = ""
    """Unit of the critical value, "1" for a pure number; empty if there is none."""
    critical_stress_between: tuple[float, float] | None = None
    """Proven bounds of the critical normal stress (Pa); None if friction is not proven to fall anywhere."""
    certificate: Verdict = "proven"
    """"proven": `folds` is complete, by interval arithmetic or because the slip rate is a state. "not decided": it is complete
    except for the slip rates in `undecided`; there only changes of sign of g' count as folds."""
    undecided: tuple[tuple[float, float], ...] = ()
    """Intervals of slip rates (m/s) where rounding hides whether g turns or touches a slope of 0."""
    folds: tuple[Fold, ...] = ()
    jumps: tuple[Jump, ...] = ()
    window: tuple[float, float] | None = None
    """Range of loads with more than one admissible slip rate, as excess over the static strength (Pa)."""
    resistance: Resistance | None = None
    """The contact equation; None if the slip rate depends on inertia or on a state of the law, and not on the load alone."""
    branches: tuple[Branch, ...] = ()
    known_to: float | None = None
    """Largest load (Pa) with all solutions known, under a law whose friction rises and falls with the slip rate for ever: `jumps`
    are then those from stick and from the slowest branches. None if all solutions are known at any load."""
    loop: Loop | None = None
    """Loop that the rule follows as the load slowly rises past all folds and comes back; None if the slip rate is a state, or if
    there is no end of folds (`known_to`)."""
    problem: Problem | None = None
    law_slip: float | None = None
    """The problem, and the slip (m) of its law for these results; None stands for the slip at the start."""

    def __str__(self) -> str:
        return self.summary

    def _lines(self) -> list[tuple[str, str]]:
        """Return the parts of the result in lines of a name and a text, with at most six folds and six jumps."""
        return [*regime_lines(self), *fold_lines(self, MOST_SHOWN), ("summary", self.summary)]

    def fold_lines(self) -> list[tuple[str, str]]:
        """Return all folds, what is not decided of them, and what depends on the rule, in lines of a name and a text."""
        return list(fold_lines(self))

    @in_given_units
    def plot(self, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the set K: every pair of slip rate and load that solves the contact equation, and the jumps of the rule.

        The keywords `ax`, `figure`, `size` and `dpi` say where to draw, and how large, as for `solution.plot()`. Raises InputError
        if the slip rate is a state.
        """
        from stickslip.figures.contact import admissible
        from stickslip.figures.sheet import known_to_pyplot

        assert self.problem is not None
        return known_to_pyplot(
            admissible.draw_admissible(admissible.admissible_data(self.problem, law_slip=self.law_slip), **place), place
        )

    @property
    def backward(self) -> Uniqueness | None:
        """What holds for backward slip where friction differs with the direction of slip."""
        turned = None if self.problem is None else self.problem.facing(-1)
        return None if turned is None or turned is self.problem else uniqueness_of(turned, self.law_slip)

    @property
    def loop_area(self) -> float:
        """The area of the `loop` (Pa m/s), 0 if the slip rate is a state."""
        return self.loop.area if self.loop else 0.0

    @property
    def plateaus(self) -> tuple[Plateau, ...]:
        """The intervals with flat g: at one load all their slip rates solve the equation, and no rule picks one."""
        return self.resistance.plateaus if self.resistance else ()

    def g(self, rate: ArrayLike) -> NDArray[np.float64]:
        """Return the resistance Z v + S mu(v) to slip (Pa) at slip rates v (m/s), an odd function of v; 0 means the limit 0+.

        Raises InputError if the slip rate is a state: a block, a contact with mass, or a law with a state.
        """
        rates = np.asarray(rate, float)
        ways = [g.strength + g.excess(np.abs(rates)) for g in (self._equation(), (self.backward or self)._equation())]
        return np.where(rates < 0.0, -ways[1], ways[0])

    def admissible(self, load: float) -> NDArray[np.float64]:
        """Return all slip rates (m/s) that solve the contact equation at a load (Pa), ascending, with stick (0) and backward slip.

        If all slip rates of an interval are solutions, its two ends represent it: see `continuum`. Raises InputError if the slip
        rate is a state: a block, a contact with mass, or a law with a state.
        """
        return self._solutions(load)[0]

    def stability(self, load: float) -> NDArray[np.bool_]:
        """Return True for each `admissible` rate that is stable, shape (n,).

        A rate is stable if g rises there or if the contact sticks. Folds and plateaus are not stable. Raises as `admissible` does.
        """
        return self._solutions(load)[1]

    def continuum(self, load: float) -> tuple[float, float] | None:
        """Return the interval of slip rates (m/s) that all solve the contact equation at a load (Pa, to its rounding), or None.

        Raises as `admissible` does.
        """
        at = self._plateau(load)
        if at is None:
            return None
        return (at.rate_from, at.rate_to) if load >= 0.0 else (-at.rate_to, -at.rate_from)

    def _plateau(self, load: float) -> Plateau | None:
        g = (self if load >= 0.0 else self.backward or self)._equation()
        rounding = 4.0 * float(np.spacing(max(abs(load), g.strength)))
        return next((p for p in g.plateaus if abs(p.excess - (abs(load) - g.strength)) <= rounding), None)

    def _equation(self) -> Resistance:
        if self.resistance is None:
            raise InputError("admissible slip rates: here they do not follow from the load alone, but from inertia or a state too")
        return self.resistance

    def _solutions(self, load: float) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        g, flat, plateau = self._equation(), self.continuum(load), self._plateau(load)
        other = (self.backward or self)._equation()
        if self.known_to is not None and abs(load) > self.known_to:
            unit = "Pa" if self.problem is None else self.problem.load_unit
            known = f"they are known for loads up to {self.known_to:.6g} {unit}"
            raise InputError(f"admissible slip rates: {known}, got {load:.6g} {unit}")
        # the plateau's own excess is exact, while load - strength carries the rounding of the load
        level = {} if plateau is None else {load >= 0.0: plateau.excess}
        forward, stable = rates_at(g, self.branches, level.get(True, load - g.strength))
        backward, mirrored = rates_at(other, (self.backward or self).branches, level.get(False, -load - other.strength))
        moving, kept = backward > 0.0, forward > (-1.0 if -other.strength <= load <= g.strength else 0.0)
        rates = np.concatenate((-backward[moving][::-1], forward[kept]))
        kinds = np.concatenate((mirrored[moving][::-1], stable[kept]))
        if flat is None:
            return rates, kinds
        inside = (rates >= flat[0]) & (rates <= flat[1]) & (rates != 0.0)
        ends = [end for end in flat if end != 0.0 or 0.0 not in rates]
        rates, kinds = np.append(rates[~inside], ends), np.append(kinds[~inside], np.zeros(len(ends), bool))
        order = np.argsort(rates)
        return rates[order], kinds[order]


@for_users
def uniqueness(problem: Problem | Scenario | str | Path, law_slip: float | str | WithUnit | None = None) -> Uniqueness:
    """Determine whether the load fixes the slip rate of a contact, and otherwise what the selection rule does.

    The problem may also be given by its scenario, the name of a bundled scenario, or a scenario file. For a block, a contact with
    mass and a law with a state, the answer is "regular". `law_slip` (m, or a text with a unit) is the slip as the law counts it;
    the initial slip by default. The contact is regular if g(v) = Z v + S mu(v) increases, otherwise irregular (Campillo et al.
    1996, section 3).

    Raises InputError if friction falls at least as fast as Z v rises even at the fastest rate of the search, or if the table of the
    selection rule cannot be followed; for a scenario also as `stickslip.load_scenario` does.

    See Also
    --------
    stickslip.studies.critical_value : the value of a parameter where the answer ceases to be unique.
    stickslip.selection : the rules that select one of several answers.

    Examples
    --------
    >>> import stickslip as ss
    >>> body = ss.ElasticSlab(thickness="10 km", density=2700, wave_speed="3 km/s", normal_stress="100 MPa")
    >>> law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha="1 s/m")
    >>> answer = ss.uniqueness(ss.Problem(body, law, pull_rate="3 cm/year", initial_excess=0.0))
    >>> print(answer.regime, f"above {answer.critical_parameter} = {answer.critical_value:.4f} {answer.critical_unit}")
    irregular above alpha = 0.1620 s/m
    """
    return uniqueness_of(read_problem("uniqueness", problem), law_slip)


def uniqueness_of(problem: Problem, law_slip: float | str | WithUnit | None = None) -> Uniqueness:
    """Determine the uniqueness of the slip rate of a problem: see `stickslip.uniqueness`."""
    slip = None if law_slip is None else quantities_of(Problem)["initial_slip"].check("uniqueness", "law_slip", law_slip)
    # A rule of the user can be registered again under its name, and its result must then not be an old one.
    return (_kept if problem.selection in SELECTION_RULES else _determined)(problem, slip)


def _determined(problem: Problem, slip: float | None) -> Uniqueness:
    """Determine the uniqueness at a slip (m) of the law; None stands for the initial one."""
    if problem.friction.backward_from:
        found: Uniqueness = of_both_ways(problem, *(_determined(problem.facing(way), slip) for way in (1, -1)))
        return found
    if problem.body.has_inertia:
        said = INERTIA.format(body=problem.body.what_is_heavy, rule=problem.rule)
        return Uniqueness("regular", problem.rule, said, problem=problem, law_slip=slip)
    if problem.friction.states:
        text = STATE if rises_with_rate(problem.friction) else STATE_FALLS
        said = text.format(law=type(problem.friction).__name__, rule=problem.rule)
        return Uniqueness("regular", problem.rule, said, problem=problem, law_slip=slip)
    g = resistance(problem, slip)
    proof = proof_of(g)
    stable = branches_of(g, proof)
    table, folds = table_of(problem, g, stable), _folds(g, stable, proof)
    between = critical_stress_between(g)
    window, critical, endless = window_of(stable), _critical(problem, g, slip), proof.reach < FASTEST_BOUNDED
    jumps = jumps_of(g, stable, table, min(len(stable), MOST_LEFT) if endless else len(stable)) if window else ()
    return Uniqueness(
        regime=named_regime(g, window),
        rule=problem.rule,
        summary=summary_of(problem, g, critical, window, jumps)
        + sentence(g, proof, folds)
        + said_of_pressing(problem, g)
        + WITH_DASHPOT * bool(problem.body.dashpot),
        critical_parameter=critical[0] if critical else None,
        critical_value=critical[1] if critical else None,
        critical_unit=problem.parameters[critical[0]].unit if critical else "",
        critical_stress_between=between,
        certificate=proof.verdict,
        undecided=proof.undecided,
        folds=folds,
        jumps=jumps,
        window=window,
        resistance=g,
        branches=stable,
        known_to=g.largest_load if endless else None,
        loop=None if endless else loop_of(g, stable, table),
        problem=problem,
        law_slip=slip,
    )


_kept = lru_cache(maxsize=16)(_determined)
"""The same function, which keeps its last results: a run, its tables and its notes ask for the same problem again and again."""


def _critical(problem: Problem, g: Resistance, slip: float | None) -> tuple[str, float] | None:
    """Return the parameter that the law names and its critical value; the normal stress for other laws."""
    stress, name = critical_normal_stress(g), problem.friction.critical
    value = nearest_critical(problem, name, slip) if name else None
    if value is not None:
        return name, value
    return None if stress is None else (normal_name(problem), stress)


def _folds(g: Resistance, stable: tuple[Branch, ...], proof: Certificate) -> tuple[Fold, ...]:
    ends = {end: None for b in stable for end in ((b.rate_from, b.excess_from), (b.rate_to, b.excess_to))}
    moving = sorted((rate, excess) for rate, excess in ends if 0.0 < rate < np.inf)
    return tuple(Fold(rate, g.strength + excess, proof.enclosure(rate), g.load_unit) for rate, excess in moving)
