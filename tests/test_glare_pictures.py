"""Pictures about glare, and why a number changed."""

import json
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine
from sunpeak.glare_compare import compare
from sunpeak.glare_draw import limits, panel, pixels_of
from sunpeak.glare_rules import RULES

VIEW = "-vta -vd 0 1 0 -vu 0 0 1 -vh 180 -vv 180"
SIZE = 240


def lamp(azimuth_deg: float, luminance: float, radius_deg: float = 5.0, background: float = 200.0) -> sp.Picture:
    view = sp.View.parse(VIEW)
    azimuth = np.radians(azimuth_deg)
    middle = np.array([np.sin(azimuth), np.cos(azimuth), 0.0])
    inside = view.rays(SIZE, SIZE).directions @ middle > np.cos(np.radians(radius_deg))
    values = np.where(inside, luminance, background) / 179
    return sp.Picture.of(np.repeat(values[..., None], 3, axis=2), view)


def test_the_change_is_the_sum_of_its_parts() -> None:
    before, after = sp.glare(lamp(30, 6000)), sp.glare(lamp(30, 12000, background=400))
    found = compare(before, after)
    [change] = found.sources
    assert change.what == "luminance × 2"
    assert found.dgp_change == pytest.approx(after.dgp - before.dgp)
    assert found.ev_change == pytest.approx(5.87e-5 * (after.ev_lux - before.ev_lux))
    assert found.ev_change + change.dgp_change == pytest.approx(found.dgp_change)
    assert found.other_change == pytest.approx(0, abs=1e-12)


def test_sources_that_come_and_go() -> None:
    moved = compare(sp.glare(lamp(30, 6000)), sp.glare(lamp(-30, 6000)))
    assert sorted(change.what for change in moved.sources) == ["gone", "new"]
    assert moved.dgp_change == pytest.approx(0, abs=2e-4)
    other = compare(sp.glare(lamp(30, 6000)), sp.glare(lamp(30, 6000), rules="evalglare-3"))
    assert other.other_change == pytest.approx(-0.001, abs=1e-6)


def test_numbers_of_pixels_are_those_of_the_report() -> None:
    picture = lamp(30, 6000)
    report = sp.glare(picture)
    drawn = panel(picture, report, "", RULES["sunpeak"])
    rows, columns = np.nonzero(drawn.numbers == 1)
    assert rows.size == report.sources[0].pixels
    middle = pixels_of(picture, np.array([report.sources[0].direction]))[0]
    assert middle == pytest.approx((columns.mean(), rows.mean()), abs=0.2)
    assert limits([picture]) == (100, 10_000)


def test_drawing_and_comparing_on_the_command_line(sunpeak: CommandLine, tmp_path: Path) -> None:
    lamp(30, 6000).save(tmp_path / "a.hdr")
    lamp(20, 60_000, radius_deg=2).save(tmp_path / "b.hdr")
    options = ["--position-index", "--task", "0,-30,20", "-o", "both.png", "-o", "both.svg"]
    sunpeak("glare", "draw", "a.hdr", "b.hdr", *options, folder=tmp_path)
    assert (tmp_path / "both.png").read_bytes().startswith(b"\x89PNG")
    assert "<svg" in (tmp_path / "both.svg").read_text()
    answer = sunpeak("glare", "draw", "a.hdr", "-o", "a.jpg", folder=tmp_path, expect=1)
    assert ".png or .svg" in answer.err
    found = json.loads(sunpeak("glare", "compare", "a.hdr", "b.hdr", "--json", folder=tmp_path).out)
    assert found["dgp_change"] == pytest.approx(found["dgp_after"] - found["dgp_before"])
    assert "what differs" in sunpeak("glare", "compare", "a.hdr", "b.hdr", folder=tmp_path).out
