"""The tour as a folder: what is packed comes out again, and the folder is whole or not there at all."""

from __future__ import annotations

import base64
import json
import re
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stickslip.cli.main import main
from stickslip.extensions.explorer.model.solve import solve
from stickslip.extensions.explorer.model.tour import TOUR
from stickslip.extensions.explorer.page.panels import view_of
from stickslip.extensions.explorer.static import export
from stickslip.extensions.explorer.static.export import (
    COARSE,
    LARGEST_PACKED,
    SHORT_COLUMN,
    check_folder,
    content_of,
    packed,
    script,
    write_tour,
)
from stickslip.foundation.errors import InputError


def unpacked(one: Any) -> Any:
    """What the page makes of a packed column."""
    if isinstance(one, list):
        return np.array([np.nan if number is None else number for number in one], float)
    raw = np.frombuffer(base64.b64decode(one["whole"]), f"<u{one['bits'] // 8}").astype(float)
    most = LARGEST_PACKED[one["bits"]]
    values = np.where(raw > most, np.nan, one["low"] + raw / most * (one["high"] - one["low"]))
    return values.reshape(one["shape"]) if "shape" in one else values


def content(text: str) -> Any:
    """What a script of the folder hands to the page."""
    found = re.fullmatch(r'stickslipStep\((\d+),"([A-Za-z0-9+/=]+)"\)\n', text)
    assert found
    return int(found[1]), json.loads(zlib.decompress(base64.b64decode(found[2])))


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("shape", [(50,), (7, 9)])
def test_a_packed_column_is_right_to_half_a_step(bits: int, shape: tuple[int, ...]) -> None:
    values = np.random.default_rng(3).normal(size=shape)
    values.flat[5] = np.nan
    found = unpacked(packed([values] if len(shape) == 2 else values, bits))
    np.testing.assert_allclose(found, values, rtol=0, atol=0.5001 * (np.nanmax(values) - np.nanmin(values)) / LARGEST_PACKED[bits])
    assert found.shape == shape


@pytest.mark.parametrize("values", [[], [1.5, np.nan], np.full(SHORT_COLUMN + 1, 3.25), np.full(SHORT_COLUMN + 1, np.nan)])
def test_short_constant_and_empty_columns_are_exact(values: Any) -> None:
    np.testing.assert_array_equal(unpacked(packed(values)), np.asarray(values, float))


def test_lines_of_several_points_stay_lines() -> None:
    assert packed([np.array([0.0, 1.0]), np.array([2.0, np.nan, 4.0])]) == [[0.0, 1.0], [2.0, None, 4.0]]


def test_a_script_cannot_be_left_by_its_content() -> None:
    text = script("stickslipStep", 3, {"text": '")</script><script>alert("'})
    assert content(text) == (3, {"text": '")</script><script>alert("'})


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("k", [0, 5], ids=["block", "slab"])
def test_the_kept_answer_of_a_step_is_that_of_its_setting(k: int) -> None:
    step = TOUR[k]
    kept = content_of(step, 2)
    own = kept["places"][kept["start"]]
    answer = solve(step.setting.scenario())
    view = view_of(answer)
    assert own["words"]["sentence"] == answer.sentence
    for source, columns in view.columns.items():
        for name, values in columns.items():
            whole = list(values)
            if not whole or any(np.ndim(one) == 1 for one in whole):
                continue
            expected = np.asarray(whole[0] if np.ndim(whole[0]) == 2 else whole, float)
            found = unpacked(own["view"]["columns"][source][name])
            reach = np.ptp(expected[np.isfinite(expected)]) if np.isfinite(expected).any() else 0.0
            np.testing.assert_allclose(found, expected, rtol=1e-6, atol=reach * (2.1e-3 if name in COARSE else 1e-5))
    assert [place["at"] for place in kept["places"]] == sorted(place["at"] for place in kept["places"])
    assert len(kept["places"]) == 3


# ---- the folder -------------------------------------------------------------------------------------------------------------


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Answers that cost nothing, for tests of the folder alone."""
    monkeypatch.setattr(export, "content_of", lambda step, places: {"places": [0] * places, "title": step.title})


@pytest.mark.usefixtures("quick")
def test_the_folder_holds_all_that_the_page_asks_for_and_nothing_from_elsewhere(tmp_path: Path) -> None:
    said: list[str] = []
    written = write_tour(tmp_path / "tour", said.append, places=2)
    assert said[0] == "step 1 of 8: Two systems"
    assert len(said) == 8
    files = {str(path.relative_to(tmp_path / "tour")) for path in (tmp_path / "tour").rglob("*") if path.is_file()}
    assert files == {"index.html", "bokeh.min.js", "README.txt"} | {f"data/step-{k}.js" for k in range(1, 9)}
    assert written.size == sum((tmp_path / "tour" / name).stat().st_size for name in files)
    assert written.answers == 16
    page = (tmp_path / "tour" / "index.html").read_text(encoding="utf-8")
    assert re.findall(r"<script[^>]* src=\"([^\"]*)\"", page) == ["bokeh.min.js"]
    assert re.findall(r"https?://(?!www\.w3\.org)[^\s\"'\\)]+", page) == []
    assert content((tmp_path / "tour" / "data" / "step-8.js").read_text(encoding="utf-8")) == (
        8,
        {"places": [0, 0], "title": "Hysteresis"},
    )


@pytest.fixture
def plain_page(monkeypatch: pytest.MonkeyPatch) -> None:
    """A page of one word."""
    monkeypatch.setattr(export, "index_page", lambda: "tour")


@pytest.mark.usefixtures("quick", "plain_page")
def test_an_empty_folder_is_filled_and_another_one_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    write_tour(tmp_path / "empty", places=1)
    assert (tmp_path / "empty" / "index.html").is_file()
    for name in ("empty", "file"):
        (tmp_path / "file").write_text("mine", encoding="utf-8")
        with pytest.raises(InputError, match="exists already: choose another name"):
            write_tour(tmp_path / name)
    assert (tmp_path / "file").read_text(encoding="utf-8") == "mine"
    with pytest.raises(InputError, match="there is no folder"):
        check_folder(tmp_path / "no" / "tour")


def test_a_tour_that_fails_halfway_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(step: Any, places: int) -> Any:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(export, "content_of", fail)
    with pytest.raises(OSError, match="No space"):
        write_tour(tmp_path / "tour")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("quick", "plain_page")
def test_the_command_says_how_large_the_folder_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as done:
        main(["explore", "--static", "tour"])
    assert done.value.code == 0
    said = capsys.readouterr()
    assert re.fullmatch(r"tour: the tour of 8 steps with 200 answers, \d\.\d MB; open index.html in it\n", said.out)
    with pytest.raises(SystemExit):
        main(["explore", "--static", "tour"])
    assert capsys.readouterr().err.startswith("stickslip: explore: --static tour: this exists already")
