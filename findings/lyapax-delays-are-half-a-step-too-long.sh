#!/usr/bin/env bash
# lyapax 0.3.0: with a delay of whole steps, which is the default, what is delayed is read once a step, where the step begins, whatever
# the integrator. On the average a delay is therefore half a step too long: y' = -y(t - 1) with y = 1 before and a step of 0.1 ends at
# 0.049085 at t = 10, by the method of Heun and by that of Runge and Kutta; with a delay of 1.05 it is 0.049136, with the delay of 1 that was
# asked for 0.020241. The largest exponent is -0.272, with 1.05 it is -0.2705, with 1 -0.3181. The documentation says that the order of the
# integrator is lost; that what remains is a longer delay it does not. The remedy is interpolate=True: then rk4 ends at 0.020249.
#
# Usage: findings/lyapax-delays-are-half-a-step-too-long.sh [PYTHON]   (makes and removes a virtual environment)
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"${1:-python3}" -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install --no-compile "lyapax==0.3.0" "jax==0.10.2" "scipy==1.17.1" "numpy==2.4.6"
"$folder/venv/bin/python" - <<'END'
import math
from importlib.metadata import version

import jax

jax.config.update("jax_enable_x64", True)
import jax.numpy as jnp
import numpy as np
from lyapax.dde import dde_problem, lyapunov_spectrum_dde
from scipy.special import lambertw


def exact(time: float, delay: float = 1.0) -> float:
    """Return the solution at a time by the method of steps."""
    powers = range(math.floor(time / delay) + 2)
    return sum((-1) ** k * (time - (k - 1) * delay) ** k / math.factorial(k) for k in powers)


def exponent(delay: float = 1.0) -> float:
    """Return the largest real part of an exponent."""
    return float((lambertw(-delay) / delay).real)


def run(integrator: str, interpolate: bool, step: float = 0.1) -> tuple[float, float]:
    """Return y(10) and the largest exponent."""
    problem = dde_problem(lambda y, past: -past, jnp.array([1.0]), 1.0, step, integrator=integrator, interpolate=interpolate)
    begun = (problem.state0, problem.buf0, 0, problem.params)
    _, values = jax.lax.scan(problem.step_fn, begun, None, length=round(10.0 / step))
    spectrum = lyapunov_spectrum_dde(problem, n_steps=round(200.0 / step), k=1, t_transient=20.0)
    return float(np.ravel(values)[-1]), float(np.ravel(spectrum.exponents)[0])


print("lyapax", version("lyapax"))
for integrator in ("heun", "rk4"):
    end, largest = run(integrator, interpolate=False)
    print(f"{integrator}: y(10) = {end:.6f}, largest exponent {largest:.4f}")
    assert abs(end - 0.0490853) < 1e-6
    assert abs(largest + 0.2720) < 2e-3
print(f"exact with a delay of 1.05: {exact(10.0, 1.05):.6f}, {exponent(1.05):.4f}; with 1: {exact(10.0):.6f}, {exponent():.4f}")
assert abs(exact(10.0, 1.05) - 0.0491358) < 1e-6 and abs(exact(10.0) - 0.0202411) < 1e-6
end, largest = run("rk4", interpolate=True)
print(f"rk4 with interpolate=True: y(10) = {end:.6f}, largest exponent {largest:.4f}")
assert abs(end - exact(10.0)) < 2e-5
print("as described")
END
