"""Critical values: closed forms against the root finder and against a dense scan of slopes."""

import math
import subprocess
import sys
from dataclasses import dataclass, replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.branches import resistance
from stickslip.contact.critical import critical_normal_stress, margin
from stickslip.contact.roots import sign_change
from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.functions import exp

from .laws import S, Z, closed_critical_value, hyperbolic, slab_problem

F = ss.friction

CLOSED = {
    "hyperbolic": hyperbolic(1.0),
    "exponential, n = 1": F.ExponentialStribeck(0.6, 0.4, 0.1, 1),
    "exponential, n = 2": F.ExponentialStribeck(0.6, 0.4, 0.1, 2, viscosity=0.02),
    "exponential, n = 5": F.ExponentialStribeck(0.6, 0.4, 9.0, 5),
    "power, n = 1": F.PowerStribeck(0.6, 0.4, 5.0, 1),
    "power, n = 2": F.PowerStribeck(0.6, 0.4, 0.1, 2),
    "power, n = 3": F.PowerStribeck(0.7, 0.1, 0.1, 3, viscosity=0.1),
    "polyline": F.PiecewiseLinearRate((0.0, 0.01, 1.0, 2.0), (0.6, 0.5, 0.3, 0.4)),
    "coulomb": F.Coulomb(0.6, 0.5),
    "sum": F.SlipPlusRate(F.LinearSlipWeakening(0.4, 0.2, 0.4), F.ExponentialStribeck(0.3, 0.2, 0.1)),
}


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("name", CLOSED)
def test_closed_forms_agree_with_the_root_finder(name):
    problem = slab_problem(CLOSED[name])
    place, value = closed_critical_value(CLOSED[name])
    found = ss.studies.critical_value(problem, place)
    assert found.value == pytest.approx(value, rel=1e-12, abs=0)
    assert found.parameter.endswith(place)
    assert set(found.regimes) == {"regular", "irregular"}
    assert len(found.regimes) == len(found.values) + 1


@pytest.mark.parametrize("name", CLOSED)
def test_uniqueness_tells_the_critical_value_that_the_law_names(name):
    """It is found from the formula; a law of points names no parameter, and the critical normal stress is told."""
    told = ss.uniqueness(slab_problem(CLOSED[name]))
    place, value = closed_critical_value(CLOSED[name])
    assert told.critical_parameter == place == (CLOSED[name].critical or "normal_stress")
    assert told.critical_value == pytest.approx(value, rel=1e-14, abs=0)


@pytest.mark.parametrize("rate", [1e-9, 1e9])
@pytest.mark.parametrize("exponent", [1, 4])
def test_the_critical_value_is_told_however_far_it_is(exponent, rate):
    law = F.PowerStribeck(0.6, 0.4, rate, exponent, viscosity=0.02)
    value = closed_critical_value(law)[1]
    assert ss.uniqueness(slab_problem(law)).critical_value == pytest.approx(value, rel=1e-14, abs=0)


def test_proofs_wait_for_no_compiler():
    """Neither `uniqueness` nor a critical value imports the compiler, in a process of its own."""
    code = """
import sys
import stickslip as ss
from stickslip.contact.critical import critical_value
problem = ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), ss.friction.PowerStribeck(0.6, 0.4, 0.1, 4), initial_excess=0.0)
print(ss.uniqueness(problem).certificate, critical_value(problem, "rate").certificate, "numba" in sys.modules)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "proven proven False\n"


def test_the_edge_of_what_a_problem_accepts_can_be_critical():
    """Static friction may not be below dynamic friction, and the contact is regular where both are equal, to the last bit."""
    for dynamic in np.random.default_rng(5).uniform(0.1, 0.5, 20).round(6).tolist():
        law = F.Coulomb(0.6, dynamic)
        assert ss.uniqueness(slab_problem(law)).critical_value == dynamic


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("k", [0.2, 3.0])
def test_of_two_critical_values_the_one_beside_the_present_value_is_told(k):
    """Friction falls by 0.5 k exp(-k), which is straight neither in k nor in its inverse."""

    @dataclass(frozen=True)
    class Both(F.FrictionLaw):
        kind = "both"
        critical = "k"
        k: float = quantity("1", "number")

        @staticmethod
        def formula(law, u, v):
            return 0.3 + 0.5 * law.k * exp(-law.k) / (1.0 + v)

        def range(self):
            return 0.3, 0.3 + 0.5 * self.k * math.exp(-self.k)

    all_values = ss.studies.critical_value(slab_problem(Both(k)), "k").values
    assert len(all_values) == 2
    nearest = min(all_values, key=lambda one: abs(math.log(one / k)))
    assert ss.uniqueness(slab_problem(Both(k))).critical_value == pytest.approx(nearest, rel=1e-13, abs=0)


def test_a_critical_parameter_that_does_not_exist_is_one_line():
    class Misnamed(F.HyperbolicRate):
        critical = "alpa"

    with pytest.raises(ss.InputError, match=r"^Misnamed: critical: parameter 'alpa' is unknown; did you mean 'alpha'\?"):
        ss.uniqueness(slab_problem(Misnamed(0.8, 0.3, 1.0)))


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("name", [name for name in CLOSED if name != "coulomb"])
@pytest.mark.parametrize("step", [-1e-6, 1e-6])
def test_the_regime_changes_where_it_is_said_to(name, step):
    place, value = closed_critical_value(CLOSED[name])
    changed = slab_problem(CLOSED[name]).parameters[place].put(value * (1.0 + step))
    found = ss.studies.critical_value(changed, place)
    side = found.regimes[0] if step < 0 else found.regimes[-1]
    assert ss.uniqueness(changed).regime == side
    assert (margin(changed) < 0.0) == (side == "irregular")


def test_laws_that_never_weaken_enough_have_no_critical_value():
    strengthening = F.VelocityStrengthening(0.6, 0.01, 1e-6, 0.1)
    rising = F.ExponentialStribeck(0.4, 0.6, 0.1), F.PowerStribeck(0.4, 0.6, 0.1), F.PiecewiseLinearRate((0.0, 1.0), (0.4, 0.6))
    for law in (strengthening, *rising, hyperbolic(1.0, static=0.3, dynamic=0.8)):
        assert ss.uniqueness(slab_problem(law)).critical_value is None
    for law in (strengthening, F.SinusoidalSlip(1.0, 0.5, 5.0), F.Coulomb(0.6, 0.5)):
        problem = slab_problem(law)
        assert critical_normal_stress(resistance(problem)) is None
        found = ss.studies.critical_value(problem, "normal_stress")
        assert (found.values, found.value) == ((), None)
        assert found.regimes == ("irregular" if isinstance(law, F.Coulomb) else "regular",)
        assert found.searched[0] < 1e2 * found.present < 1e4 * found.present < found.searched[1]


def test_a_law_without_closed_form_has_a_critical_normal_stress():
    law = F.FromExpression("b + (a - b) / (1 + alpha*v)", {"a": 0.8, "b": 0.3, "alpha": "1 s/m"})
    found = ss.uniqueness(slab_problem(law))
    assert (found.critical_parameter, found.critical_value) == ("normal_stress", pytest.approx(Z / 0.5, rel=1e-14, abs=0))
    assert "critical value is normal_stress = 19.6 MPa" in found.summary
    assert ss.studies.critical_value(slab_problem(law), "alpha").value == pytest.approx(0.196, rel=1e-13, abs=0)
    assert ss.studies.critical_value(slab_problem(law), "a").value == pytest.approx(0.3 + Z / S, rel=1e-13, abs=0)


def test_the_critical_value_of_a_product_depends_on_slip():
    law = F.SlipTimesRate(F.LinearSlipWeakening(0.7, 0.5, 0.4), F.HyperbolicRate(1.0, 0.5, 1.0))
    for slip in (0.0, 0.2, 1.0):
        factor = max(0.7 - 0.5 * slip, 0.5)
        found = ss.studies.critical_value(slab_problem(law), "rate.alpha", slip)
        assert found.value == pytest.approx(Z / (S * factor * 0.5), rel=1e-13, abs=0)
    along = ss.studies.critical_value(slab_problem(replace(law, slip=F.LinearSlipWeakening(0.7, 0.05, 0.4))), "initial.slip")
    edge = (0.7 - 0.196) * 0.4 / 0.65  # the path counts: the same backwards
    assert along.values == pytest.approx((-edge, edge), rel=1e-12, abs=0)
    assert along.regimes == ("regular", "irregular", "regular")


def test_from_zero_the_search_goes_by_orders_of_magnitude():
    law = F.ExponentialStribeck(0.6, 0.4, 1.0, viscosity=0.0)
    found = ss.studies.critical_value(slab_problem(law), "viscosity")
    assert found.value == pytest.approx(0.2 - Z / S, rel=1e-13, abs=0)
    assert found.regimes == ("irregular", "regular")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("alpa", "parameter 'alpa' is unknown; did you mean 'alpha'?"),
        ("exponent", "friction.exponent is whole"),
    ],
)
def test_parameters_that_are_unknown_or_whole_are_refused(name, message):
    law = hyperbolic(1.0) if name == "alpa" else F.PowerStribeck(0.6, 0.4, 0.1, 2)
    with pytest.raises(ss.InputError, match=message.replace("?", r"\?")):
        ss.studies.critical_value(slab_problem(law), name)


def test_friction_that_no_rate_changes_has_margin_one():
    assert margin(slab_problem(F.LinearSlipWeakening(0.6, 0.3, 2.0))) == 1.0


@pytest.mark.parametrize(
    ("function", "low", "high", "root"),
    [
        (lambda x: x**3 - 2.0, 0.0, 5.0, 2.0 ** (1 / 3)),
        (lambda x: -math.inf if x < 0.3 else 1.0, 0.0, 1.0, 0.3),
        (lambda x: math.copysign(1.0, 0.3 - x), 0.0, 1.0, 0.3),
        (lambda x: 1e-300 * (x - 0.7) ** 9, 0.0, 1.0, None),
    ],
    ids=["cubic", "jump from minus infinity", "jump down", "flat root"],
)
def test_sign_change_finds_the_crossing_from_its_upper_side(function, low, high, root):
    found = sign_change(function, low, high)
    assert function(found) >= 0.0
    if root is not None:
        assert found == pytest.approx(root, rel=1e-15, abs=0)
