"""A few whole scenes against pictures by Radiance; `validation/scenes.py` compares all and keeps the references."""

import json
import os
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

from conftest import ROOT, Radiance

sys.path.insert(0, str(ROOT / "validation"))

pytest.importorskip("pyradiance", reason="the oracle pyradiance is not installed")

import scenes
from scene_stand_ins import make_stand_ins

import sunpeak as sp

CHEAP = ["cornell_window", "frads_v1a", "tutorial_glazing", "tutorial_diffuse_glass"]
SAMPLES = 64


@pytest.mark.parametrize("name", CHEAP)
def test_scene(name: str, shared: Path, radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert (shared / "scenes").is_dir()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("RAYPATH", "")
    monkeypatch.setenv("PATH", "")
    case = next(case for case in scenes.CASES if case.name == name)
    reference = json.loads(scenes.RESULTS.read_text())[name]
    assert reference["files"] == list(case.files)
    theirs = np.array(reference["theirs"])
    comparison = scenes.Comparison(case, tmp_path, radiance)
    runs = [scenes.blocks(scenes.without_suns(comparison.ours(SAMPLES, seed))) for seed in (1, 2)]
    ours = np.mean(runs, axis=0)
    noise = scenes.relative_rms(*runs) / 2
    assert ours.mean() == pytest.approx(theirs.mean(), rel=scenes.MEAN_TOLERANCE)
    rmse = scenes.relative_rms(ours, theirs)
    assert noise < 0.03
    assert np.sqrt(max(rmse**2 - noise**2, 0.0)) <= scenes.BLOCK_TOLERANCE


def test_every_small_scene_loads(
    shared: Path, radiance: Radiance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All input files of `rad` in the collection, one of which has everything; what is missing is made."""
    folder = tmp_path / "scenes"
    shutil.copytree(shared / "scenes/radiance-renders", folder, copy_function=shutil.copyfile)
    make_stand_ins(tmp_path, radiance)
    monkeypatch.chdir(folder)
    monkeypatch.setenv("RAYPATH", f"{tmp_path}:.:{radiance.library}")
    monkeypatch.setenv("PATH", str(radiance.programs), prepend=os.pathsep)
    inputs = sorted(folder.glob("*.rif"))
    assert len(inputs) > 15
    for file in inputs:
        found = sp.check_scene(file, allow_commands=True)
        assert found.errors == []
        assert found.surfaces > 20
        assert sp.View.load(file).kind.startswith("-vt")
