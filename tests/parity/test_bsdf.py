"""Scattering tables against Radiance's own library and program, on real files."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import sunpeak as sp
from conftest import CommandLine, Radiance, luminance

# Radiance's library moves values by up to 3e-4, so that neighbouring cells differ.
PERTURBATION = 4e-4

REFUSED_BY_RADIANCE = {"not-xml", "short-matrix_must-be-refused", "roman-shade_klems-full_crlf_radiance-rejects"}

FILES = [
    "blinds_klems-full_leading-text",
    "blinds_t3-1024_leading-text",
    "clear-glass-3mm_klems-full",
    "clear-glass_t4-4096",
    "diffuse-glass_klems-full",
    "diffusing-panel_klems-full",
    "electrochromic-60_klems-full",
    "escreen-3pct-charcoal_klems-full",
    "escreen-3pct_klems-half",
    "escreen-3pct_klems-quarter",
    "louvre_t4-256",
    "metal-grate_klems-full_xyz",
    "metal-grate_t3-1024",
    "metal-grate_t4-256",
    "shade-020_klems-full",
    "shade-2011-sa1_klems-full",
    "silverscreen-2pct-dark-gray_klems-full",
]

# In a process of its own: the library keeps every file that it has seen.
ASK = """
import json, sys
import pyradiance.bsdf as library
table = library.load_file(sys.argv[1])
pairs = json.load(sys.stdin)
values = [library.query(table, *pair).tolist() for pair in pairs]
halves = [library.SAMPLE_DF | library.SAMPLE_SPT, library.SAMPLE_DF | library.SAMPLE_SPR]
hemispherical = [[library.direct_hemi(table, *pair[:2], half) for half in halves] for pair in pairs]
json.dump({"values": values, "hemispherical": hemispherical}, sys.stdout)
"""


def angles(count: int, seed: int) -> np.ndarray:
    """Random theta and phi [deg] over the sphere, twice a row."""
    random = np.random.default_rng(seed)
    theta = np.degrees(np.arccos(random.uniform(-1, 1, (count, 2))))
    phi = random.uniform(0, 360, (count, 2))
    return np.stack([theta[:, 0], phi[:, 0], theta[:, 1], phi[:, 1]], axis=1)


def ask(path: Path, pairs: np.ndarray) -> dict[str, np.ndarray]:
    """What the library says."""
    pytest.importorskip("pyradiance", reason="the oracle pyradiance is not installed")
    done = subprocess.run(
        [sys.executable, "-c", ASK, path], input=json.dumps(pairs.tolist()), capture_output=True, text=True, check=True
    )
    return {key: np.array(value) for key, value in json.loads(done.stdout).items()}


@pytest.fixture(params=FILES)
def path(request: pytest.FixtureRequest, shared: Path) -> Path:
    return shared / "bsdf" / f"{request.param}.xml"


def test_every_file_is_asked_for(shared: Path) -> None:
    found = {file.stem for file in (shared / "bsdf").glob("*.xml")}
    assert found - REFUSED_BY_RADIANCE == set(FILES)


def test_values(path: Path) -> None:
    pairs = angles(400, seed=1)
    theirs = ask(path, pairs)["values"]
    ours = sp.Bsdf.load(path).evaluate(sp.direction(*pairs[:, :2].T), sp.direction(*pairs[:, 2:].T))
    np.testing.assert_allclose(ours, theirs[:, 1], rtol=PERTURBATION, atol=1e-9)


def test_hemispherical_values(path: Path) -> None:
    """To 2e-3: the library sums trees over cumulative tables of limited size."""
    pairs = angles(100, seed=2)
    theirs = ask(path, pairs)["hemispherical"]
    bsdf, w_in = sp.Bsdf.load(path), sp.direction(*pairs[:, :2].T)
    for mode, expected in zip(("transmission", "reflection"), theirs.T, strict=True):
        np.testing.assert_allclose(bsdf.hemispherical(w_in, mode), expected, rtol=2e-3, atol=1e-5, err_msg=mode)


def through_by_radiance(
    radiance: Radiance, path: Path, w_in: np.ndarray, folder: Path, sources: np.ndarray
) -> np.ndarray:
    """T [-] of view rays through one aBSDF polygon, with glows of 0.2 degrees around -`sources`.

    Nothing but the straight ray is followed (-ab 0 -st 1), and glows of negative radius are no targets of shadow rays:
    so a ray sees the one source that it is aimed at, however many there are.
    """
    glows = "".join(f"g source s{i} 0 0 4 {-x:.15g} {-y:.15g} {-z:.15g} 0.2\n" for i, (x, y, z) in enumerate(sources))
    scene = (
        f"void aBSDF m 5 {path} 0 1 0 . 0 0\n"
        "m polygon p 0 0 12 -100 -100 0 100 -100 0 100 100 0 -100 100 0\n"
        "void glow g 0 0 4 1 1 1 -1\n" + glows
    )
    octree = radiance.octree(folder / "through.oct", text=scene)
    return luminance(radiance.rtrace(octree, np.hstack([w_in, -w_in]), "-ab", "0", "-st", "1", "-ss", "0")) / 179.0


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def agree(ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    return np.abs(ours - theirs) <= PERTURBATION * theirs + 1e-5


def at_a_border(bsdf: sp.Bsdf, w_in: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Do we say what they say within 1e-6 of the direction? Then one of the 29 looks is so close to a cell's border."""
    jitter = 1e-6 * np.random.default_rng(5).uniform(-1, 1, (len(w_in), 100, 3))
    near = unit(w_in[:, None, :] + jitter)
    ours = bsdf.through(near.reshape(-1, 3), "radiance").reshape(near.shape[:2])
    return agree(ours, theirs[:, None]).any(axis=1)


def over_the_sphere(count: int, seed: int) -> np.ndarray:
    return sp.direction(*angles(count, seed)[:, :2].T)


def borders(bsdf: sp.Bsdf, seed: int) -> np.ndarray:
    """Directions at which our T changes, to the last bit: by halving the way between two that differ."""
    a = over_the_sphere(600, seed)
    b = unit(a + np.random.default_rng(seed).uniform(-0.2, 0.2, a.shape) * [1, 1, 0])
    first = bsdf.through(a, "radiance")
    differ = bsdf.through(b, "radiance") != first
    a, b, first = a[differ], b[differ], first[differ]
    for _ in range(60):
        middle = unit(a + b)
        same = (bsdf.through(middle, "radiance") == first)[:, None]
        a, b = np.where(same, middle, a), np.where(same, b, middle)
    return b


def test_through_transmittance_in_radiance_mode(path: Path, radiance: Radiance, tmp_path: Path) -> None:
    """500 directions a side: T is theirs, but where one of the looks falls on a cell's border."""
    w_in = over_the_sphere(1000, seed=3)
    w_in[500:] = w_in[:500] * [1, 1, -1]
    theirs = through_by_radiance(radiance, path, w_in, tmp_path, sources=w_in)
    bsdf = sp.Bsdf.load(path)
    ours = bsdf.through(w_in, "radiance")
    differ = ~agree(ours, theirs)
    explained = at_a_border(bsdf, w_in[differ], theirs[differ])
    unexplained = [
        f"{w}: {o} {t}"
        for w, o, t in zip(w_in[differ][~explained], ours[differ][~explained], theirs[differ][~explained], strict=True)
    ]
    assert not unexplained
    assert explained.sum() <= 5


def test_rays_see_the_source_behind_the_surface_and_no_other(path: Path, radiance: Radiance, tmp_path: Path) -> None:
    w_in, others = over_the_sphere(100, seed=4), over_the_sphere(500, seed=6)
    apart = (w_in @ others.T).max(axis=1) < np.cos(np.radians(0.11))
    assert apart.sum() > 90
    theirs = through_by_radiance(radiance, path, w_in[apart], tmp_path, sources=others)
    assert not theirs.any()


def test_differences_at_the_borders_of_cells_are_told_from_errors(
    path: Path, radiance: Radiance, tmp_path: Path
) -> None:
    """Where the ray's last digit decides which cell is looked at, every difference is explained; an error is not."""
    bsdf = sp.Bsdf.load(path)
    w_in = borders(bsdf, seed=7)
    if len(w_in) == 0:
        assert not bsdf.through(over_the_sphere(1000, seed=8), "radiance").any(), "no peak, no border"
        return
    theirs = through_by_radiance(radiance, path, w_in, tmp_path, sources=w_in)
    differ = ~agree(bsdf.through(w_in, "radiance"), theirs)
    assert differ.sum() > 10
    assert at_a_border(bsdf, w_in[differ], theirs[differ]).all()
    elsewhere = over_the_sphere(500, seed=9)
    wrong = bsdf.through(elsewhere, "radiance") * 1.001 + 2e-5
    assert at_a_border(bsdf, elsewhere, wrong).sum() <= 5


@pytest.mark.parametrize("name", sorted(REFUSED_BY_RADIANCE - {"roman-shade_klems-full_crlf_radiance-rejects"}))
def test_unsound_files_are_refused_with_their_place(name: str, shared: Path) -> None:
    path = shared / "bsdf" / f"{name}.xml"
    with pytest.raises(sp.InputError, match=rf"{name}\.xml:\d+:\d+: .*expected"):
        sp.Bsdf.load(path)


def test_the_command_line_means_the_azimuth_towards_which_the_ray_runs(
    shared: Path, radiance: Radiance, sunpeak: CommandLine, tmp_path: Path
) -> None:
    """An asymmetric blind: rays towards azimuth 90 and 270 do not see the same T."""
    path = shared / "bsdf" / "blinds_klems-full_leading-text.xml"
    theta, phi = np.radians(40.0), np.radians([90.0, 270.0])
    rays = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.full(2, -np.cos(theta))], axis=1)
    theirs = through_by_radiance(radiance, path, -rays, tmp_path, sources=-rays)
    text = sunpeak("bsdf", "through", path, "--theta", "40", "--phi", "90,270", "--peak", "radiance", "--json").out
    ours = [row["through"] for row in json.loads(text)["through"]]
    assert theirs.max() > 10 * theirs.min()
    np.testing.assert_allclose(ours, theirs, rtol=PERTURBATION, atol=1e-5)
