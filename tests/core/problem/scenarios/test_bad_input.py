"""Everything that can be wrong with a scenario file: one line with the file, the place, what was found and what is allowed."""

from pathlib import Path

import pytest

from stickslip import InputError
from stickslip.problem.scenarios.scenario import load_scenario, read_scenario
from tests.core.problem.scenarios.texts import GOOD

LENGTH = 'must be a number in m or a text with a unit such as "10 m"'
DENSITY = 'must be a number in kg/m^3 or a text with a unit such as "10 kg/m^3"'
STRESS = 'must be a number in Pa or a text with a unit such as "10 Pa"'
CREEP = "must be 0 (no leaps over creep, every round trip is run) or at most 0.01"
BODIES = (
    "block-on-belt, block-on-disc, elastic-slab, layered-slab, position-loop, rotary-loop and 6 more:"
    " `stickslip new --list` lists all"
)
FAR = "far_stress and far_stress_rate need a slab with a finite driver_impedance"

CASES = [
    ("density = 2800", "density = true", f"[body] density {DENSITY}, got True"),
    ('"10 km"', '"10 kg"', f"[body] thickness {LENGTH}, got '10 kg': 'kg' does not convert to m"),
    ('"10 km"', '"-10 km"', "[body] thickness must be greater than 0 m, got -10000 (from '-10 km')"),
    ('"10 km"', '"1e999 km"', "[body] thickness must be finite, got inf (from '1e999 km')"),
    ('"10 km"', '"10 m\\u001b[31m"', f"[body] thickness {LENGTH}, got '10 m\\x1b[31m'"),
    ('"10 km"', "1979-05-27", f"[body] thickness {LENGTH}, got 1979-05-27"),
    ("thickness =", "thicknes =", "[body] thicknes is unknown; did you mean 'thickness'?"),
    ("thickness =", "duration =", "[body] duration is unknown; it belongs in [run]"),
    (
        "thickness =", "mass =",
        "[body] mass is unknown; it is a key of block-on-belt, position-loop, spring-block, and not of this kind",
    ),
    ("thickness =", '"th ick\\n" =', "[body] 'th ick\\n' is unknown; did you mean 'thickness'?"),
    ('thickness = "10 km"\n', "", "[body] thickness is missing: thickness h, in m, above 0"),
    ('kind = "elastic-slab"', 'kind = "elastic-slap"', "[body] kind 'elastic-slap' is unknown; did you mean 'elastic-slab'?"),
    ('kind = "elastic-slab"', "kind = 3", f"[body] kind 3 is unknown; allowed: {BODIES}"),
    ('kind = "elastic-slab"\n', "", f"[body] kind is missing; allowed: {BODIES}"),
    ('kind = "hyperbolic-rate"', 'kind = "hyperbolic"', "[friction] kind 'hyperbolic' is unknown; did you mean 'hyperbolic-rate'?"),
    ("static = 0.8", 'static = "0.8"', "[friction] static must be a number, got '0.8': write a number without quotes"),
    ("static = 0.8", "static = -0.8", "[friction] static must be at least 0 (a pure number), got -0.8"),
    ("[loading]", "[laoding]", "[laoding] is unknown; did you mean 'loading'?"),
    ('title = "good"', "title = 5", "title must be text in quotes, got 5"),
    ('title = "good"', 'titel = "good"', "titel is unknown; did you mean 'title'?"),
    ("[initial]\nexcess = 0.0\n", "", "[initial] needs either load or excess (load minus static strength), got neither"),
    ('kind = "elastic-slab"', 'kind = "slab"', "[body] kind 'slab' is unknown; did you mean 'elastic-slab' or 'layered-slab'?"),
    ("[initial]\nexcess = 0.0\n", "[[initial]]\nexcess = 0.0\n", "[initial] must be a table, got [{'excess': 0.0}]"),
    ("excess = 0.0", "slip = 0.0", "[initial] needs either load or excess (load minus static strength), got neither"),
    ("excess = 0.0", "excess = 0.0\nload = 1.0", "[initial] needs either load or excess (load minus static strength), got both"),
    ("excess = 0.0", 'excess = "5 N"', f"[initial] excess {STRESS}, got '5 N': 'N' does not convert to Pa"),
    ("excess = 0.0", "excess = 0.0\nstate = 1.0", "[initial] state: HyperbolicRate has no state variable"),
    ("pull_rate =", "far_stress = 5.0\npull_rate =", f"[loading] {FAR}"),
    ('"12 s"', '"0 s"', "[run] duration must be greater than 0 s, got 0 (from '0 s')"),
    ('"12 s"', "-3", "[run] duration must be greater than 0 s, got -3"),
    ('"12 s"', '"12 s"\nrtol = 0.5', "[run] rtol must be at most 0.01 (a pure number), got 0.5"),
    ('"12 s"', '"12 s"\nrtol = 0.0', "[run] rtol must be at least 1e-15 (a pure number), got 0"),
    ('"12 s"', '"12 s"\ncreep_rtol = -1e-6', "[run] creep_rtol must be at least 0 (a pure number), got -1e-06"),
    ('"12 s"', '"12 s"\ncreep_rtol = 0.5', f"[run] creep_rtol {CREEP}, got 0.5"),
    ('"12 s"', '"12 s"\nevents = 2.5', "[run] events must be a whole number above 0, got 2.5"),
    ('"12 s"', '"12 s"\nselection = "maxwel"', "[run] selection 'maxwel' is unknown; did you mean 'maxwell'?"),
    (
        '"12 s"',
        '"12 s"\nselection = 3',
        "[run] selection 3 is unknown; allowed: maximal, maxwell, minimal, perfect-delay or a registered one",
    ),
    ('"12 s"', '"12 s"\np_wave = ', "line 19: 'p_wave =' is not TOML: Invalid value"),
    ('"12 s"', "1" + 5000 * "0", None),
    ('"12 s"', 3000 * "[", None),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "message"), CASES)
def test_one_line_says_what_is_wrong_and_what_is_allowed(old: str, new: str, message: str | None) -> None:
    assert GOOD.count(old) == 1
    with pytest.raises(InputError) as caught:
        read_scenario(GOOD.replace(old, new), "my.toml")
    text = str(caught.value)
    assert "\n" not in text
    assert text.isprintable()
    assert text.startswith("my.toml: ")
    assert message is None or text == f"my.toml: {message}"


def test_the_text_without_mistakes_is_read() -> None:
    scenario = read_scenario(GOOD, "my.toml")
    assert scenario.problem.body.thickness == 1e4
    assert scenario.rtol == 1e-10


def test_a_law_that_refuses_its_numbers_is_placed() -> None:
    text = GOOD.replace('"hyperbolic-rate"', '"coulomb"').replace("alpha = 1.0\n", "").replace("dynamic = 0.3", "dynamic = 0.9")
    with pytest.raises(InputError, match=r"^my.toml: \[friction\] static must be at least dynamic, got static 0.8 < dynamic 0.9$"):
        read_scenario(text, "my.toml")


@pytest.mark.parametrize("rigid", ["inf", '"inf"', '"rigid"'])
def test_a_driver_may_be_rigid_by_number_or_by_word(rigid: str) -> None:
    text = GOOD.replace("density = 2800", f"density = 2800\ndriver_impedance = {rigid}")
    assert read_scenario(text, "my.toml") == read_scenario(GOOD, "my.toml")


@pytest.mark.parametrize("bad", ["nan", "-inf", '"stiff"', "-1.0"])
def test_a_driver_may_not_be_anything_else(bad: str) -> None:
    with pytest.raises(InputError, match=r"^my.toml: \[body\] driver_impedance must be "):
        read_scenario(GOOD.replace("density = 2800", f"density = 2800\ndriver_impedance = {bad}"), "my.toml")


def test_loads_of_a_block_are_forces() -> None:
    body = 'kind = "spring-block"\nmass = "1 tonne"\nstiffness = "1 kN/m"\nnormal_force = "10 kN"\n'
    start, end = GOOD.index("kind = "), GOOD.index("[friction]")
    text = GOOD[:start] + body + GOOD[end:]
    assert read_scenario(text.replace("excess = 0.0", 'load = "1 kN"'), "b").problem.load == 1000.0
    with pytest.raises(InputError, match=r"^b: \[initial\] load must be a number in N .* 'Pa' does not convert to N$"):
        read_scenario(text.replace("excess = 0.0", 'load = "1 Pa"'), "b")


def test_bad_files_are_refused_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"fig6-slap: no such file, and no bundled .*; did you mean 'fig6-slab'\?$"):
        load_scenario("fig6-slap")
    with pytest.raises(InputError, match=r"lost.toml: no such file, .*; `stickslip new --list` lists them$"):
        load_scenario(tmp_path / "lost.toml")
    file = tmp_path / "a.toml"
    file.write_bytes(b"#" * 1_000_001)
    with pytest.raises(InputError, match=r"a.toml: larger than 1000000 bytes: not a scenario$"):
        load_scenario(file)
    file.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())
    assert load_scenario(str(file)).name == "a"


def test_a_table_of_an_extension_that_is_not_there_is_unknown_to_all_extensions() -> None:
    """Whoever is handed a scenario of somebody with one more extension is told where to look."""
    with pytest.raises(InputError, match=r"^my\.toml: \[seismometer\] is unknown to stickslip and its extensions here; allowed: "):
        read_scenario(GOOD + "\n[seismometer]\ndistance = 1.0\n", "my.toml")
    with pytest.raises(InputError, match=r"^my\.toml: seismometer is unknown; allowed: "):
        read_scenario("seismometer = 1.0\n" + GOOD, "my.toml")
