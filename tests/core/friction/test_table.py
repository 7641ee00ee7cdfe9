"""Measured points: monotone cubic against scipy's, files and what is wrong with them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from stickslip import InputError, load_scenario
from stickslip.friction import FromTable, PiecewiseLinearRate
from stickslip.problem.scenarios.scenario import read_scenario
from stickslip.problem.scenarios.templates import template
from tests.messages import refused

points = st.lists(st.tuples(st.floats(0.01, 2.0), st.floats(0.0, 1.5)), min_size=2, max_size=12)


@pytest.mark.filterwarnings("ignore::stickslip.foundation.errors.InputWarning")  # drawn points may well look noisy
@given(points, st.booleans())
def test_the_cubic_is_that_of_scipy_exact_at_points_and_monotone_between(
    drawn: list[tuple[float, float]], along_slip: bool
) -> None:
    places = np.round(np.cumsum([step for step, _ in drawn]), 6)
    values = np.array([round(value, 6) for _, value in drawn])
    law = FromTable(**{"slip" if along_slip else "rate": places.tolist()}, friction=values.tolist())
    between = np.linspace(places[:-1], places[1:], 41)
    at = [(x, 0.0) if along_slip else (0.0, x) for x in (places, between, places[-1] + 9.0, 0.0)]
    assert (law.coefficient(*at[0]) == values).all()
    mu = law.coefficient(*at[1])
    np.testing.assert_allclose(mu, PchipInterpolator(places, values)(between), rtol=1e-12, atol=1e-13)
    assert (np.diff(mu, axis=0) * np.sign(np.diff(values)) >= -1e-14).all()
    assert float(law.coefficient(*at[2])) == values[-1]
    assert float(law.coefficient(*at[3])) == values[0]


def test_net_slip_has_a_side_below_the_first_point() -> None:
    law = FromTable(slip=[-1.0, 0.0, 1.0], friction=[0.5, 0.6, 0.4], counts="net")
    assert law.coefficient([-3.0, -1.0, 0.0, 1.0, 3.0]).tolist() == [0.5, 0.5, 0.6, 0.4, 0.4]
    assert len(law.pieces) == 4


BAD_POINTS: list[tuple[dict[str, Any], str]] = [
    ({"friction": [0.5, 0.4]}, "give either slip or rate, got neither"),
    ({"slip": [0, 1], "rate": [0, 1], "friction": [0.5, 0.4]}, "give either slip or rate, got both"),
    ({"slip": [0, 1, 2], "friction": [0.5, 0.4]}, "3 places but 2 friction coefficients"),
    ({"slip": [0], "friction": [0.5]}, "must have 2 to 10000 numbers, got 1"),
    ({"slip": [0, 0], "friction": [0.5, 0.4]}, r"slip must ascend, but \[1\] = 0 follows 0"),
    ({"slip": [0, np.nan], "friction": [0.5, 0.4]}, r"slip\[1\] must be finite"),
    ({"slip": [-1, 1], "friction": [0.5, 0.4]}, r"slip\[0\] must be at least 0 where the path is counted"),
    ({"rate": [-1, 1], "friction": [0.5, 0.4]}, r"rate\[0\] must be at least 0"),
    ({"slip": [0, 1], "friction": [0.5, -0.4]}, r"friction\[1\] must be at least 0"),
    ({"slip": "ab", "friction": [0.5, 0.4]}, "slip must be a list of numbers in m, got str"),
    ({"slip": 3, "friction": [0.5, 0.4]}, "slip must be a list of numbers in m, got int"),
    ({"slip": [[0, 1]], "friction": [0.5, 0.4]}, "slip must be a list of numbers in m, got list"),
]


@pytest.mark.parametrize(("given_points", "message"), BAD_POINTS)
def test_bad_points_are_refused(given_points: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        FromTable(**given_points)


FILE = 'file = "data/x.csv"'


def scenario(table: str, kind: str = "table") -> str:
    text = template("slab", kind)
    start, end = text.index(f'kind = "{kind}"  # '), text.index("# The motion of the driver")
    return f'{text[:start]}kind = "{kind}"\n{table}\n{text[end:]}'


def load(folder: Path, content: str | bytes, table: str = FILE, kind: str = "table") -> Any:
    (folder / "data").mkdir(exist_ok=True)
    (folder / "data" / "x.csv").write_bytes(content.encode() if isinstance(content, str) else content)
    (folder / "s.toml").write_text(scenario(table, kind))
    return load_scenario(folder / "s.toml").problem.friction


def test_tables_are_read_from_files(tmp_path: Path) -> None:
    wanted = FromTable(slip=[0.0, 0.1, 1.0], friction=[0.7, 0.6, 0.4])
    assert load(tmp_path, "# measured\nslip (m), friction\n0, 0.7\n\n0.1,0.6\n1.0,0.4\n") == wanted
    assert load(tmp_path, "\ufefftime,friction,slip (m)\r\n1,0.7,0\r\n2,0.6,1e-1\r\n3,0.4,1\r\n") == wanted
    assert load(tmp_path, "slip_rate (m/s),friction\n0,0.7\n1,0.6\n") == FromTable(rate=[0, 1], friction=[0.7, 0.6])
    law = load(tmp_path, "slip_rate (m/s),friction\n0,0.7\n1,0.6\n", kind="piecewise-linear-rate")
    assert law == PiecewiseLinearRate((0.0, 1.0), (0.7, 0.6))
    law = load(tmp_path, "slip (m),friction\n-1,0.7\n1,0.6\n", f'{FILE}\ncounts = "net"')
    assert law.counts == "net"


BAD_FILES = [
    ("", "line 1: no column 'friction' in the header"),
    ("slip,tau\n0,1\n", "line 1: no column 'friction' in the header; friction is shear stress over normal stress"),
    ("slip,fricton\n0,1\n", "line 1: no column 'friction' in the header; rename 'fricton'?"),
    ("0,0.7\n1,0.6\n", "line 1: no column 'friction'"),
    ("slips,friction\n0,1\n", "line 1: the header needs a column slip or slip_rate, got none; rename 'slips'?"),
    ("slip (m),slip_rate (m/s),friction\n0,0,1\n", "line 1: the header needs a column slip or slip_rate, got both"),
    ("slip (m),friction\n0,0.7\n", "line 2: at least two rows of numbers are needed, got 1"),
    ("slip (m),friction\n", "line 1: at least two rows of numbers are needed, got 0"),
    ("slip (m),friction\n0,0.7\n\n# so\n1,x\n", "line 5: friction must be a number, got text"),
    ("slip (m),friction\n-1,0.7\n1,0.1\n", "slip[0] must be at least 0 where the path is counted"),
    ("slip (m),friction\n" + "".join(f"{i},0.5\n" for i in range(10_002)), "more than 10000 rows"),
]  # fmt: skip


@pytest.mark.parametrize(("content", "message"), BAD_FILES)
def test_bad_files_are_refused_in_one_line_with_file_and_line(tmp_path: Path, content: str | bytes, message: str) -> None:
    with refused(message, begins=f"{tmp_path / 's.toml'}: [friction] "):
        load(tmp_path, content)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ('file = "lost.csv"', "'lost.csv': no such file beside the scenario"),
        ('file = "data"', "no such file"),
        ('file = "/etc/hosts"', "the path must be relative to the scenario"),
        ('file = "a\\u0000b"', "the path must be relative"),
        ("file = 3", "file must be text in quotes, got 3"),
        ('file = "data/x.csv"\nslip = [0, 1]', "file and slip exclude each other"),
        ('slip = [0, 1]\nfriction = "0.5"', "friction must be a list of numbers in (a pure number)"),
        ("slip = [0, 1]\nfriction = [0.5, true]", "[friction] friction[1] must be a number, got True"),
        ('slip = [0, "1 kg"]\nfriction = [0.5, 0.4]', "[friction] slip[1] must be a number in m"),
        ("slip = [0, 1]", "[friction] friction is missing: friction coefficients at the points"),
        ("slips = [0, 1]\nfriction = [0.5, 0.4]", "[friction] slips is unknown; did you mean 'slip'?"),
    ],
)
def test_bad_tables_of_a_scenario_are_refused(tmp_path: Path, table: str, message: str) -> None:
    with refused(message):
        load(tmp_path, "slip (m),friction\n0,1\n1,1\n", table)


def test_a_text_without_a_folder_names_no_files() -> None:
    with pytest.raises(InputError, match="only a scenario in a file can name another file"):
        read_scenario(scenario(FILE), "text")
