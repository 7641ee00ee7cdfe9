#!/usr/bin/env bash
# pint 0.25.3 reads Nm, as torque is written on most machines, as the fineness of yarn ("number metric", m/g), not as newton metres;
# kNm and daNm are then 1000 and 10 of it. N*m and newton_meter are torques. So a column of torque headed "Nm" is refused where a
# torque is wanted, with a message about lengths and masses, and passes without a word where it is divided by another such column.
# mil, a thousandth of an inch to those who measure displacement in it, is an angle: 1/64000 of a turn (the angular mil of gunners
# is 1/6400). A thousandth of an inch is thou.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" --quiet --disable-pip-version-check install "pint==0.25.3"
"$folder/venv/bin/python" - <<'END'
import pint

units = pint.UnitRegistry()
print("pint", pint.__version__)
seen = {}
for word in ("Nm", "kNm", "daNm", "N*m", "mil", "thou"):
    quantity = units(word).to_base_units()
    seen[word] = f"{quantity.magnitude:g} {quantity.units}"
    print(f"1 {word} is {seen[word]}")
try:
    units("5 Nm").to("N*m")
    raised = "nothing"
except pint.DimensionalityError as error:
    raised = str(error)
print("5 Nm to N*m:", raised)
ratio = (units("10 Nm") / units("5 kNm")).to("").magnitude
print("10 Nm / 5 kNm =", ratio, "without a word")
assert seen["Nm"] == "1000 meter / kilogram" and seen["kNm"] == "1e+06 meter / kilogram", seen
assert seen["N*m"] == "1 kilogram * meter ** 2 / second ** 2"
assert abs(units("mil").to("turn").magnitude - 1 / 64000) < 1e-12
assert seen["thou"].endswith("meter")
assert "Cannot convert" in raised
print("as described")
END
