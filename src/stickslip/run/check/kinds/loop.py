"""What `check` says of axes in a position loop: how near the gains are to the edge of stability, and whether friction hunts."""

from __future__ import annotations

from collections.abc import Iterator

from stickslip.foundation.names import si_unit
from stickslip.foundation.show import brief
from stickslip.problem import Problem, loading_rate
from stickslip.problem.bodies import as_on_spring
from stickslip.run.check.asked import Fact
from stickslip.run.check.kinds.rigid import CheckOfRigid


class CheckOfLoop(CheckOfRigid):
    """The answers of axes in a position loop."""

    def numbers(self, problem: Problem) -> list[Fact]:
        """Return period, damping ratio, the largest integral gain, and the lag that friction holds."""
        body, first, size = as_on_spring(problem.body), ", at first" if problem.loading_varies else "", problem.body.impedance
        per_way, unit = si_unit("stiffness", body.load_unit), problem.unit_of
        largest = body.total_damping * body.stiffness / body.inertia
        found = [
            Fact("period", body.period, "s", "period 2 pi sqrt(m/kp) of free oscillation without an integral"),
            Fact("damping ratio", 0.5 * body.total_damping / size, "1", "(damping + kd) / (2 sqrt(kp m))"),
            Fact("loading", loading_rate(problem), unit("load_rate"), f"growth of the controller's force while stuck{first}"),
        ]
        if body.integral_gain:
            edge = "above it steady motion is unstable even where friction does not fall with the slip rate"
            found.insert(2, Fact("largest ki", largest, f"{per_way}/s", f"(damping + kd) kp / m: {edge}"))
        if problem.friction.sticks:
            held = problem.strength / body.stiffness
            found.append(Fact("strength / kp", held, unit("slip"), "lag that ends rest by the proportional gain alone"))
        return found

    def chosen(self, problem: Problem) -> Iterator[str]:
        """Yield what the reference does before the start, and whether the axis hunts."""
        body = as_on_spring(problem.body)
        if body.reference_step:
            yield f"the reference jumps by {brief(body.reference_step, problem.unit_of('slip'))} at the start, and the load with it"
        largest = body.total_damping * body.stiffness / body.inertia
        if body.integral_gain > largest:
            unit = f"{si_unit('stiffness', body.load_unit)}/s"
            given = f"the integral gain {brief(body.integral_gain, unit)} exceeds the largest ki {brief(largest, unit)}"
            yield f"{given}: the axis swings with a growing amplitude even where friction does not fall with the slip rate"
        if hunts := why_it_hunts(problem):
            yield hunts

    def stability(self, problem: Problem, by_slip: float, by_rate: float) -> str:
        """Return whether the loop holds a small disturbance of slip at the start: Routh's conditions of three orders."""
        body = as_on_spring(problem.body)
        if not body.integral_gain:
            return super().stability(problem, by_slip, by_rate)
        spring, dash = body.stiffness + body.normal_load * by_slip, body.total_damping + body.normal_load * by_rate
        damps, asked = dash * spring, body.inertia * body.integral_gain
        impedance, unit = si_unit("impedance", body.load_unit), f"({si_unit('stiffness', body.load_unit)})^2 s"
        values = f"(damping + kd + S mu'(v)) (kp + S mu'(u)) = {damps:.6g} against m ki = {asked:.6g} {unit}"
        if dash <= 0.0 or damps <= asked:
            why = f"damping + kd + S mu'(v) = {dash:.6g} {impedance} " if dash <= 0.0 else ""
            return f"oscillates with growing amplitude in slip: {why}{values}"
        return f"stable in slip: {values}"


def why_it_hunts(problem: Problem) -> str:
    """Return a sentence on hunting about a reference at rest under a law that sticks; empty where nothing is known of it."""
    body, law = as_on_spring(problem.body), problem.friction
    if not (law.sticks and body.integral_gain) or law.depends_on_slip or law.states:
        return ""
    share = law.static_excess * problem.normal
    fall = float(law.slopes(0.0)[1])
    if share > 0.0:
        why = f"static friction exceeds that of sliding by {brief(share, problem.load_unit)}"
        return f"hunts about a reference at rest: {why}, so that a break-away jumps however small the lag is"
    if fall < 0.0:
        return "may hunt about a reference at rest: friction falls as slip begins"
    return "does not hunt about a reference at rest if it is stable in slip: friction does not fall as slip begins"


ANSWERS = CheckOfLoop()
