#!/usr/bin/env bash
# JiTCDDE 1.8.3 gives no first answer in an environment into which only it was installed: it needs sympy, which pip does not bring,
# because only the extra "test" of jitcdde and jitcxde_common asks for it (symengine, which is asked for, imports sympy in its
# `simplify`).
#
# What is seen here, for the equation of Mackey and Glass as in its documentation:
#   compile_C()         ModuleNotFoundError: No module named 'sympy': up to ten equations are simplified by default, and all delays
#   generate_lambdas()  the same, without simplification, too
#   compile_C(simplify=False), with delays=[0, 15] given to jitcdde(): answers, which is the way around it
# With sympy installed all of them answer. Exit code 0: it is still so; 1: it is no longer so.
#
# Usage: findings/jitcdde-needs-sympy-unsaid.sh [PYTHON]   (makes and removes a virtual environment; needs a C compiler)
set -euo pipefail

python=${1:-python3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$python" -m venv "$folder/venv"
pip=("$folder/venv/bin/pip" --disable-pip-version-check --quiet install)
"${pip[@]}" "jitcdde==1.8.3" "jitcxde_common==1.5.6" "symengine==0.15.0"

cat > "$folder/first.py" <<'END'
import sys

from jitcdde import jitcdde, t, y

past = y(0, t - 15.0)
delays = {"delays": [0.0, 15.0]} if sys.argv[1] == "unsimplified" else {}
run = jitcdde([0.25 * past / (1.0 + past**10) - 0.1 * y(0)], verbose=False, **delays)
run.constant_past([1.0])
try:
    if sys.argv[1] == "lambdas":
        run.generate_lambdas(simplify=False)
    else:
        run.compile_C(**({"simplify": False} if sys.argv[1] == "unsimplified" else {}))
    run.step_on_discontinuities()
    print(f"{run.integrate(100.0)[0]:.9f}")
except ModuleNotFoundError as error:
    print(error)
END
answers() {
    for way in compiled lambdas unsimplified; do
        echo "$way: $(cd "$folder" && venv/bin/python -W ignore first.py "$way" 2> /dev/null | tail -n 1)"
    done
}
without=$(answers)
"${pip[@]}" "sympy==1.14.0"
with=$(answers)
printf 'as installed\n%s\n\nwith sympy\n%s\n' "$without" "$with"
missing="No module named 'sympy'"
answer="1.264104887"
[[ $without == "compiled: $missing"$'\n'"lambdas: $missing"$'\n'"unsimplified: $answer" ]] || exit 1
[[ $with == "compiled: $answer"$'\n'"lambdas: $answer"$'\n'"unsimplified: $answer" ]] || exit 1
echo "as described"
