#!/usr/bin/env bash
# heyoka.py 7.13.2: a Taylor series is one branch of `select` for the whole step, because the condition is asked where the step begins.
# A mass of 1 kg, thrown at 1 m/s against dry friction of 1 N, has a constant acceleration on that branch, so that nothing limits the
# step: one step of 10 s takes it back to x = -40 m at -9 m/s, where friction of 1 N on a mass without any other force has long
# stopped it, at 1 s and 0.5 m. The outcome is `time_limit`, as of every run that comes to its end. At the next step the other branch
# throws it as far again. With a spring the steps are 1 s: the mass passes its turning points by up to a step and does not come to
# rest at all, where the exact one rests from 7.7 s on. The remedy is a terminal event at v = 0, with the branch chosen by the caller:
# then the stop is exact.
#
# Usage: findings/heyoka-select-jumps-late.sh [PYTHON]   (makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${1:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "heyoka==7.13.2" "numpy==2.4.6"
"$folder/venv/bin/python" - <<'END'
import math

import heyoka as hy

x, v = hy.make_vars("x", "v")
friction = hy.select(hy.gt(v, 0.0), 1.0, -1.0)
print("heyoka", hy.__version__)

thrown = hy.taylor_adaptive([(x, v), (v, -friction)], [0.0, 1.0])
outcome = thrown.propagate_until(10.0)[0]
print(f"thrown at 1 m/s, after {thrown.time} s: {thrown.state[0]:.6f} m, {thrown.state[1]:.6f} m/s, {outcome.name}; exact: 0.5 m, at rest")
assert outcome == hy.taylor_outcome.time_limit
assert abs(thrown.state[0] + 40.0) < 1e-9 and abs(thrown.state[1] + 9.0) < 1e-9

# On a spring of 1 N/m: x = -1 + cos t + 5 sin t up to the first turning point, and each half period of pi takes 2 m off the swing.
turn, first = math.atan(5.0), math.sqrt(26.0) - 1.0
swing = first
rest = turn
while abs(swing) > 1.0:
    swing, rest = -(swing - math.copysign(2.0, swing)), rest + math.pi
sprung = hy.taylor_adaptive([(x, v), (v, -x - friction)], [0.0, 5.0])
sprung.propagate_until(40.0)
late = abs(sprung.state[1])
print(f"on a spring, thrown at 5 m/s, after 40 s: {sprung.state[0]:.4f} m, {sprung.state[1]:.4f} m/s; exact: at rest at {swing:.4f} m from {rest:.2f} s on")
assert late > 1e-3

stops = hy.taylor_adaptive([(x, v), (v, hy.expression(-1.0))], [0.0, 1.0], t_events=[hy.t_event(v)])
stops.propagate_until(10.0)
print(f"with a terminal event at v = 0: stops at {stops.time:.12f} s and {stops.state[0]:.12f} m")
assert abs(stops.time - 1.0) < 1e-12 and abs(stops.state[0] - 0.5) < 1e-12
print("as described")
END
