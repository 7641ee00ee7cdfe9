"""The guided tour: eight steps through the paper, each with a setting, a text, a place to look at, a question and a strip.

The numbers in the texts are calculated in the tests, from runs of these very settings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.strip import strip_range
from stickslip.foundation.axis import Axis

Panel = Literal["law", "contact", "shape", "slip", "rate", "traction", "field", "energy", "profile_rate", "profile_slip"]
"""The panels of the page that a step can point to."""


@dataclass(frozen=True)
class TourStep:
    """One step of the tour: what is seen and why, in 40 to 80 words; a sentence that follows "Look at"; and something to try.

    It shows a bundled scenario with `changes`, entries by their path (None leaves an entry away), a panel to look at with the
    cursor at a time (s), and a parameter to move.
    """

    title: str
    text: str
    look: str
    question: str
    panel: Panel
    cursor: float
    strip: Axis | None
    scenario: str
    changes: Mapping[str, Any] = field(default_factory=dict)

    @property
    def setting(self) -> Setting:
        """The setting of the step."""
        setting = Setting.bundled(self.scenario)
        for path, value in self.changes.items():
            setting = setting.with_value(path, value)
        return setting


TOUR = (
    TourStep(
        "Two systems",
        "A block on a spring and an elastic slab slide under the same friction law, which weakens with slip rate. The "
        "block has mass: its slip rate rises smoothly to 3.511 m/s and returns to zero at 2.226 s, after 2.061 m. The "
        "slab's contact has no mass. Its slip rate jumps to 4.102 m/s at once, and it slips until 5.714 s, when its own "
        "wave returns from the driver.",
        "the two lines of slip rate: one is a hump, the other a step with two corners.",
        "The paper prints a spring ten times as stiff, 3.43e14 N/m. Does the block still slip?",
        "rate",
        1.84,
        strip_range("body.stiffness", 1e13, 4e14, log=True),
        "fig6-block-reconstructed",
    ),
    TourStep(
        "A law of slip",
        "Here friction depends on how far the contact has slipped: it goes up and down as a sine. The contact starts 1 cm"
        " beyond a maximum, where friction falls with slip. Friction falls faster than the slab unloads, so the slip "
        "accelerates. It is fastest, 10.2 m/s, at 1.568 s, in the trough of friction. The waves that the slab sends out "
        "limit the slip rate. Beside the next maximum the slip fades.",
        "the run along the law: it starts beside a maximum and ends near the next one.",
        "Move the start closer to the maximum, which is at 0.3142 m. When does the pulse come?",
        "law",
        1.568,
        strip_range("initial.slip", 0.317, 0.335),
        "fig5-slab-u0-1e-2",
        {"initial.excess": None, "initial.load": 1.5e8},
    ),
    TourStep(
        "Pulses",
        "With ten times as many waves of friction in each metre the slab slips in pulses. Each pulse carries it from one "
        "maximum of friction to the next, 0.1257 m. Beside a maximum the contact almost stands still, until friction "
        "falls again. Three pulses come, at 0.154, 2.257 and 4.359 s. At 5.714 s the echo arrives and stops everything, "
        "after 0.376 m.",
        "slip: a staircase with three steps, which the echo cuts off.",
        "A thicker slab gets its echo later. Why does its slip grow in steps?",
        "slip",
        2.257,
        strip_range("body.thickness", 1e3, 2.2e4),
        "fig5-slab-reconstructed",
    ),
    TourStep(
        "A law of slip rate",
        "Now friction falls with slip rate. But a slab that slips at the rate v sends out waves, which take the stress Z "
        "v. What balances the load is the sum of both, g(v). With alpha = 0.1 s/m that sum rises everywhere: each load "
        "has one slip rate. The load goes up from 60 to 85.5 MPa and down again, and the contact returns the way it came,"
        " without any jump.",
        "g(v): the path of the run goes up along the curve and down along the same curve.",
        "Make alpha larger. From where on does the run leave the curve and jump?",
        "contact",
        2.857,
        strip_range("friction.alpha", 0.02, 0.4),
        "fig4-loop",
        {"friction.alpha": 0.1},
    ),
    TourStep(
        "Folds",
        "With alpha = 1 s/m friction falls so fast that g(v) falls too, up to 1.259 m/s, and rises from there. Where the "
        "curve turns is a fold. Loads between 64.47 and 80 MPa now have three slip rates: at 70 MPa the contact may be "
        "stuck, or slip at 0.377 or at 2.704 m/s. Friction alone does not say which. The middle one, on the falling part,"
        " is unstable.",
        "g(v): the load line of the cursor, at 70 MPa, crosses the curve three times.",
        "Make alpha smaller. Where does the falling part vanish?",
        "contact",
        4.6476,
        strip_range("friction.alpha", 0.05, 2.0),
        "fig4-loop",
    ),
    TourStep(
        "The jump",
        "The load is exactly the static strength, 80 MPa, and the slowest pull is enough: there is no slip rate close to "
        "zero to which the contact could go. It jumps to the only other solution, v = S (static - dynamic) / Z - 1 / "
        "alpha = 4.102 m/s, and the traction drops to 39.8 MPa. It keeps this rate until the echo stops it at 5.714 s, "
        "after 23.44 m of slip.",
        "slip rate: two vertical lines, and a constant between them.",
        "Change the normal stress. Why does the rate of slip follow a straight line?",
        "rate",
        2.857,
        strip_range("body.normal_stress", 1e7, 2e8),
        "fig6-slab",
    ),
    TourStep(
        "The critical alpha",
        "Jumps begin where friction weakens faster than Z v grows: above alpha_c = Z / (S (static - dynamic)) = 0.196 "
        "s/m. Here alpha is a millionth of a s/m above it. The jump is still there, but tiny: to 2.603e-05 m/s at first, "
        "and 0.1408 mm/s at the end. Below alpha_c nothing jumps at all. A jump thus begins from nothing, as a phase "
        "transition does.",
        "the strip: the peak rate leaves zero at alpha_c, and then grows.",
        "Where is alpha_c if the normal stress is twice as large?",
        "rate",
        2.857,
        strip_range("friction.alpha", 0.15, 0.25),
        "fig7-slab-critical",
    ),
    TourStep(
        "Hysteresis",
        "The load rises and falls once. The rule of perfect delay says that the contact stays as it is for as long as it "
        "can. So it sticks up to 80 MPa and jumps to slip at 2.243 s. On the way back it slips down to 64.47 MPa, the "
        "lower fold, and jumps to rest at 5.213 s. Up and down are different ways: a loop, as in the paper's Figure 4.",
        "g(v): the path makes a loop with two jumps, each at a fold.",
        "Choose the rule 'maxwell'. At which loads does the contact jump now?",
        "contact",
        5.213,
        strip_range("loading.pull_rate", 1.5, 3.0),
        "fig4-loop",
    ),
)
"""The steps of the tour, in the order of the paper."""
TOUR_OF_A_FAULT = (
    TourStep(
        "A nucleus",
        "The contact of a slab is a line here, 40 km long, and each of its nodes slides under the same law: friction falls with "
        "slip, from 0.7 to 0.5 over 40 cm. Only in a nucleus of 8 km is the load above the strength. Slip begins there at once and "
        "spreads, because what slips loads what does not. At 18 km it meets barriers, which never slip.",
        "the slip rate along the contact: two fronts leave the nucleus, while the middle slips on.",
        "Lower the load of patch 1. From where on does nothing slip at all?",
        "profile_rate",
        1.5,
        None,
        "planar-patch",
    ),
    TourStep(
        "The echo",
        "Slip sends waves into the slab, and the driver, 10 km away, sends them back. After one two-way travel time, 5.714 s, the "
        "first of them arrives and takes load off the contact: slip is over soon after. In one dimension the echo arrests "
        "everything at once. Here waves from the ends arrive, too, and some places rest before others.",
        "the contact in space and time: where the colour ends, the place has come to rest.",
        "Make the slab half as thick. How far do the fronts get before their echo comes?",
        "field",
        5.714,
        None,
        "planar-patch",
    ),
    TourStep(
        "A weaker fault",
        "With dynamic friction of 0.45 in place of 0.5 more stress is released, and each place slips faster and further. The "
        "fronts are faster, too: they come close to the speed of the waves, 3.5 km/s, which they cannot pass. The barriers stop "
        "them all the same. Pin the run of the first step to compare the two.",
        "slip in the middle: it is larger than before, and so is the drop of the traction.",
        "Make the distance of the law longer. When do the fronts become slow, or fail to start?",
        "slip",
        3.0,
        None,
        "planar-patch",
        {"friction.dynamic": 0.45},
    ),
)
"""The steps of the tour on the page of a fault in 2D."""


def tour_of(setting: Setting) -> tuple[TourStep, ...]:
    """Return the tour of a page that shows a setting."""
    return TOUR_OF_A_FAULT if setting.is_fault else TOUR
