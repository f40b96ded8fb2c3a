"""Patterns, textures and mixtures against `rtrace`, on few rays: what shines is seen directly, without samples."""

from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp
from conftest import Radiance

Floats = npt.NDArray[np.float64]

# Rays from all around to a unit sphere at the origin, from distances of 3 to 5.
RANDOM = np.random.default_rng(4)
TOWARDS = RANDOM.normal(size=(60, 3))
TOWARDS /= np.linalg.norm(TOWARDS, axis=1)[:, None]
ORIGINS = -TOWARDS * RANDOM.uniform(3, 5, (60, 1)) + RANDOM.uniform(-0.4, 0.4, (60, 3))

GRID = "2\n0 2 3\n0 0 4 -1 0 .5 2\n" + " ".join(str(round(v, 3)) for v in np.sin(np.arange(12.0)) + 2)
FALLING = "1 90 0 10 \n" + " ".join(str(v) for v in [0, 0.05, 0.08, 0.1, 0.11, 0.12, 0.14, 0.25, 1, 10])
FUNCTIONS = """
half(v) = v / 2; bright(r,g,b) = r + g / 2 + b / 3; only(v) = v * v;
stripes(n) = if(frac(n * Px) - .5, .9, .2); fine(nm) = 1.5 + sin(nm / 150 + Px);
turned(v, nm) = v * (Py + 2 + nm / 550);
local = A1 * Px + A2; A3x : 3; only01(r,g,b) = if(r - 1, 1, 0); if01(v) = if(v - 2, 1, 0);
tex(a,b,c) = .1 * a * (b - c / 2); half3(a,b,c) = a / 9;
"""


def both(
    radiance: Radiance,
    folder: Path,
    text: str,
    *options: str,
    rays: Floats | None = None,
    samples: int = 1,
    definitions: str = "",
) -> tuple[Floats, Floats]:
    """What ours and theirs see along the rays."""
    for name, content in [("grid.dat", GRID), ("falling.dat", FALLING), ("mine.cal", FUNCTIONS + definitions)]:
        (folder / name).write_text(content)
    (folder / "scene.rad").write_text(text)
    rays = np.hstack([ORIGINS, TOWARDS]) if rays is None else rays
    octree = radiance.octree(folder / "scene.oct", "scene.rad", folder=folder)
    theirs = radiance.rtrace(octree, rays, "-ab", "0", "-w", *options, folder=folder)
    scene = sp.Scene.load([folder / "scene.rad"], search_path=[folder, radiance.library])
    sensors = "-I" in options
    ours = sp.trace(scene, rays[:, :3], rays[:, 3:], samples=samples, max_bounces=0, irradiance=sensors)
    return ours, theirs


def assert_same(ours: Floats, theirs: Floats, tolerance: float) -> None:
    """Relative to the largest value."""
    assert theirs.max() > 0
    assert np.ptp(theirs) > 1e-3 * theirs.max()
    worst = np.abs(ours - theirs).max() / theirs.max()
    assert worst < tolerance, f"{worst}: {ours[:4]} {theirs[:4]}"


SHINING = "glow g 0 0 4 1 1 1 0\ng sphere s 0 0 4 0 0 0 1\n"
MOVED = "-rz 30 -rx 20 -s 1.7 -t .3 -.2 .1"

PATTERNS = {
    "direction": "colorfunc p 4 Dx+1 Dy+1 Dz+1 . 0 0",
    "normal": f"colorfunc p 14 Nx+1 Ny+1 Nz+1 . {MOVED} 0 0",
    "place": f"colorfunc p 14 Px+3 Py+3 Pz+3 . {MOVED} 0 0",
    "distances": f"colorfunc p 14 T Ts Rdot+.1 . {MOVED} 0 0",
    "mirrored frame": "colorfunc p 11 Px+3 Dy+2 Nz+2 . -mx -rz 20 -t 1 0 0 0 0",
    "axes": f"colorfunc p 14 S+Ix+1+.1*Px Ty+Jy+3 Kz+Jx+2 . {MOVED} 0 0",
    "coordinates": "colorfunc p 4 U+3 V+3 D(1)+N(2)+P(3)+4 . 0 0",
    "noise": "colorfunc p 4 noise3(Px*4,Py*4,Pz*4)+1 noise3x(Px*4,Py,Pz)+3 noise3y(Px,Py,Pz)+noise3z(Px,Py,Pz)+5 . 0 0",
    "fractal noise": "brightfunc p 2 fnoise3(Px*9,Py*9,Pz*9)+1 . 0 0",
    "turbulence": "colorfunc p 4 turbulence(Px,Py,Pz,.01) turbulencex(Px,Py,Pz,.1)+4 turbulencez(Px,Py,Pz,.1)+4 . 0 0",
    "arguments": "brightfunc p 2 local+A3x+arg(2) mine.cal 0 2 .3 .7",
    "a function file": "brightfunc p 2 stripes(3)*stripes(5) mine.cal 0 0",
    "failing": "brightfunc p 2 2/if(Px,Px,0) . 0 0",
    "data": "brightdata p 9 half grid.dat mine.cal Px+1 Py -t .2 0 0 0 0",
    "data outside": "brightdata p 5 abs grid.dat . Px*9 Py*9 0 0",
    "falling data": "brightdata p 4 noop falling.dat . Acos(Dz)/DEGREE/2 0 0",
    "colours of data": "colordata p 9 bright half only grid.dat grid.dat grid.dat mine.cal Px+1 Py 0 0",
    "three data": "colordata p 9 noop noop noop grid.dat grid.dat grid.dat . Px+1 Py 0 0",
    "two patterns": "brightfunc q 2 Px+2 . 0 0\nq colorfunc p 4 1 Py+2 .5 . 0 0",
    "a mixture of patterns": "colorfunc a 4 1 .2 .1 . 0 0\nvoid brightfunc b 2 .5 . 0 0\nvoid mixfunc p 4 a b Px . 0 0",
}


@pytest.mark.parametrize("pattern", PATTERNS.values(), ids=PATTERNS.keys())
def test_patterns_on_what_shines(pattern: str, radiance: Radiance, tmp_path: Path) -> None:
    ours, theirs = both(radiance, tmp_path, f"void {pattern}\np {SHINING}")
    assert_same(ours, theirs, 2e-6)


SPECTRA = {
    "spectrum": "spectrum p 0 0 14 380 780 .1 .2 .3 .4 .5 .6 .7 .8 .9 1 1.1 1.2",
    "a narrow spectrum": "spectrum p 0 0 12 700 500 .1 .3 .5 .7 .9 .7 .6 .4 .3 .2",
    "specfile": "specfile p 1 smooth.nm 0 0",
    "specfunc": "specfunc p 2 fine mine.cal 0 2 380 780",
    "specdata": "specdata p 4 turned grid.nm mine.cal Px 0 0",
    "specpict": "specpict p 7 turned picture.hsr mine.cal .8+Px/2 .9+Py/3 -rz 20 0 0",
}


@pytest.mark.parametrize("pattern", SPECTRA.values(), ids=SPECTRA.keys())
def test_spectra_in_three_channels(pattern: str, radiance: Radiance, tmp_path: Path) -> None:
    """The observer is a fit within 1 %, and Radiance jitters the wavelengths of `specfunc`."""
    wavelengths = np.linspace(380, 780, 81)
    smooth = [1.5 + np.sin(wavelengths / 60), 1.2 + np.cos(wavelengths / 90)]
    (tmp_path / "smooth.nm").write_text("1 380 780 81 " + " ".join(map(str, smooth[0])))
    (tmp_path / "grid.nm").write_text("2 -1 1 2 380 780 81 " + " ".join(map(str, np.concatenate(smooth))))
    spectral_picture(radiance, tmp_path / "picture.hsr")
    ours, theirs = both(radiance, tmp_path, f"void {pattern}\np {SHINING}")
    if pattern.startswith("specfunc"):
        ours, theirs = ours.mean(axis=0), theirs.mean(axis=0)
    assert np.abs(ours - theirs).max() / theirs.max() < 0.015


def spectral_picture(radiance: Radiance, path: Path) -> None:
    """By Radiance itself: rays to a rainbow with a pattern, in 12 components."""
    scene = "void specfunc s 2 wave wave.cal 0 2 380 780\ns glow g 0 0 4 1 1 1 0\n"
    (path.parent / "wave.cal").write_text("wave(nm) = if(nm-500, 1, .3) + .3*sin(nm/60+9*Dx) + Dy + .7;")
    octree = radiance.octree(
        path.with_suffix(".oct"), text=scene + "g source all 0 0 4 0 0 1 360\n", folder=path.parent
    )
    places = [(x, y) for y in np.linspace(0.4, -0.4, 7) for x in np.linspace(-0.6, 0.6, 10)]
    rays = "\n".join(f"0 0 0 {x} {y} 1" for x, y in places)
    options = ("-x", "10", "-y", "7", "-fac", "-cs", "12", "-co+", "-ab", "0", "-w")
    path.write_bytes(radiance.run("rtrace", *options, octree, data=rays + "\n", folder=path.parent))
    assert b"FORMAT=Radiance_spectra" in path.read_bytes()


SUN = "void light l 0 0 3 1e6 1e6 1e6\nl source sun 0 0 4 .3 -.5 .8 .2\n"
ON_PLASTIC = "plastic m 0 0 5 .6 .5 .4 0 0\nm sphere s 0 0 4 0 0 0 1\n"
BEHIND = "void glow b 0 0 4 1 2 3 0\nb source back 0 0 4 0 0 1 360"
TWO = "plastic a 0 0 5 .9 .1 .1 0 0\nvoid plastic b 0 0 5 .1 .9 .1 0 0\n"
SPHERE = "x sphere s 0 0 4 0 0 0 1"

LIT = {
    "a pattern on plastic": f"colorfunc p 4 Px+1 Py+1 .5 . 0 0\np {ON_PLASTIC}",
    "a pattern before plastic": "plastic m 0 0 5 .6 .5 .4 0 0\nm brightfunc p 2 Px+1 . 0 0\np sphere s 0 0 4 0 0 0 1",
    "a pattern on metal": f"colorfunc p 4 Px+1 Py+1 .5 . 0 0\np metal x 0 0 5 .6 .5 .4 .5 .2\n{SPHERE}",
    "a pattern on glass": "colorfunc p 4 (Px+1)/2 .5 .9 . 0 0\np glass x 0 0 3 .9 .8 .7\n"
    f"x ring r 0 0 8 0 0 0 0 0 1 0 3\n{BEHIND}",
    "a texture on glass": "texfunc t 4 .03*sin(9*Px) .02*Py .05 . 0 0\nt glass x 0 0 4 .9 .8 .7 1.6\n"
    f"x ring r 0 0 8 0 0 0 0 0 1 0 3\nvoid colorfunc c 4 Dx+1 Dy+1 Dz+1 . 0 0\nc {BEHIND[5:]}",
    "texfunc": f"texfunc t 6 .3*sin(4*Px) .2*noise3(Px,Py,Pz) .1*Py . -rz 30 0 0\nt {ON_PLASTIC}",
    "texfunc with scale": f"texfunc t 6 .3*sin(4*Px) .2*Dx .1*Py . -s 2 0 0\nt {ON_PLASTIC}",
    "texdata": f"texdata t 9 tex tex half3 grid.dat grid.dat grid.dat mine.cal Px+1 Py 0 0\nt {ON_PLASTIC}",
    "a texture and a pattern": f"texfunc t 4 .2*Px .1 .1 . 0 0\nt brightfunc p 2 if(Px,1,.3) . 0 0\np {ON_PLASTIC}",
    "mixfunc": f"{TWO}void mixfunc x 4 a b if(sin(9*Px),1,0) . 0 0\n{SPHERE}",
    "mixdata": f"{TWO}void mixdata x 7 a b if01 grid.dat mine.cal Px+1 Py 0 0\n{SPHERE}",
    "a mixture with void": f"{TWO}void mixfunc x 4 a void if(sin(9*Px),1,0) . 0 0\n{SPHERE}\n{BEHIND}",
    "a mixture of a mixture": f"{TWO}void mixfunc y 4 a b if(sin(9*Px),1,0) . 0 0\n"
    f"void mixfunc x 4 y b if(sin(9*Py),1,0) . 0 0\n{SPHERE}",
}


@pytest.mark.parametrize("scene", LIT.values(), ids=LIT.keys())
def test_surfaces_in_the_sun(scene: str, radiance: Radiance, tmp_path: Path) -> None:
    """Sun alone, no bounces."""
    is_glass = "glass" in scene
    ours, theirs = both(radiance, tmp_path, f"{SUN}void {scene}", samples=4096 if is_glass else 64)
    assert_same(ours, theirs, 2e-3 if is_glass else 3e-3)


@pytest.mark.parametrize("line", ["A=1", "EXPOSURE=2", "PIXASPECT=1.7", "PIXASPECT=.4", "COLORCORR= 1 2 .5"])
def test_pictures_are_looked_up(line: str, radiance: Radiance, tmp_path: Path) -> None:
    """Values as they stand in the file, whatever its exposure; the shorter side is 1."""
    pixels = np.random.default_rng(1).uniform(0.1, 2, (6, 9, 3)).astype(np.float32)
    data = "".join(" ".join(f"{value:.6g}" for value in pixel) + "\n" for pixel in pixels.reshape(-1, 3))
    picture = radiance.run("pvalue", "-r", "-h", "-d", "-y", "6", "+x", "9", data=data)
    (tmp_path / "p.hdr").write_bytes(radiance.run("getinfo", "-a", line, data=picture))
    pattern = "colorpict p 9 bright half only p.hdr mine.cal .4+Px/3 .5+Py/4 -rz 20 0 0"
    ours, theirs = both(radiance, tmp_path, f"void {pattern}\np {SHINING}")
    assert_same(ours, theirs, 2e-6)
    mixture = (
        "void glow a 0 0 4 1 0 0 0\nvoid glow b 0 0 4 0 0 1 0\n"
        "void mixpict p 7 a b only01 p.hdr mine.cal .4+Px/3 .5+Py/4 0 0\np sphere s 0 0 4 0 0 0 1"
    )
    ours, theirs = both(radiance, tmp_path, mixture)
    assert_same(ours, theirs, 2e-6)


LAMPS = {
    "flatcorr": ("1 1.5", "l polygon q 0 0 12 -.5 -.3 2 -.5 .3 2 .5 .3 2 .5 -.3 2\n"),
    "boxcorr": ("4 1.5 1 .6 .2", "!genbox l b 1 .6 .2 | xform -t -.5 -.3 1.9\n"),
    "lboxcorr": ("4 1.5 1 .6 .2", "!genbox l b 1 .6 .2 | xform -t -.5 -.3 1.9\n"),
}


@pytest.mark.parametrize("correction", LAMPS)
def test_a_lamp_with_a_measured_distribution(correction: str, radiance: Radiance, tmp_path: Path) -> None:
    """Radiance cuts the lamp into small parts; ours samples its area: both the same integral."""
    reals, shape = LAMPS[correction]
    (tmp_path / "lamp.dat").write_text("2\n0 180 5\n0 90 3\n" + " ".join(str(9 - i % 7) for i in range(15)))
    rays = np.array([[x, y, 0, 0, 0, 1] for x in (-2, -0.3, 1.1) for y in (-1, 0.2, 1.5)], dtype=np.float64)
    text = (
        f"void brightdata d 9 {correction} lamp.dat source.cal src_theta src_phi4 -t 0 0 2 0 {reals}\n"
        f"d light l 0 0 3 1 2 3\n{shape}"
    )
    ours, theirs = both(radiance, tmp_path, text, "-I", "-ds", ".02", "-dj", "0", rays=rays, samples=4096)
    assert np.abs(ours / theirs - 1).max() < 0.01, ours / theirs


def test_a_cylinder_with_a_measured_distribution(radiance: Radiance, tmp_path: Path) -> None:
    """Against the integral over the cylinder's side: Radiance takes it for a flat piece, and finds 3 to 20 % less."""
    (tmp_path / "lamp.dat").write_text("2\n0 180 5\n0 90 3\n" + "5 " * 15)
    text = (
        "void brightdata d 9 cylcorr lamp.dat source.cal src_theta src_phi4 -t 0 0 2 0 3 1.5 .4 .6\n"
        "d light l 0 0 3 1 2 3\nl cylinder c 0 0 7 0 0 1.7 0 0 2.3 .2\n"
    )
    (tmp_path / "cylinder.rad").write_text(text)
    scene = sp.Scene.load([tmp_path / "cylinder.rad"], search_path=[radiance.library, tmp_path])
    sensors = np.array([[x, y, z, -np.sign(x), 0, 0] for x in (-2, 3) for y in (-1, 0.2) for z in (1, 2)])
    ours = sp.trace(scene, sensors[:, :3], sensors[:, 3:], irradiance=True, samples=4096, max_bounces=0)
    steps = (np.arange(300) + 0.5) / 300
    phi, height = np.meshgrid(2 * np.pi * steps, 1.7 + 0.6 * steps)
    normals = np.stack([np.cos(phi), np.sin(phi), 0 * phi], axis=-1)
    points = 0.2 * normals + np.array([0, 0, 1]) * height[..., None]
    for sensor, found in zip(sensors, ours, strict=True):
        towards = points - sensor[:3]
        distance = np.linalg.norm(towards, axis=-1)
        towards /= distance[..., None]
        leaving, arriving = -(towards * normals).sum(axis=-1), (towards * sensor[3:]).sum(axis=-1)
        cosine = np.abs(towards[..., 2])
        shown = 0.4 * 0.6 * np.sqrt(1 - cosine**2) + np.pi / 4 * 0.4**2 * cosine
        flux = (1.5 * 5 / shown * leaving * arriving / distance**2)[(leaving > 0) & (arriving > 0)]
        expected = flux.mean() * ((leaving > 0) & (arriving > 0)).mean() * 2 * np.pi * 0.2 * 0.6
        assert found == pytest.approx(expected * np.array([1, 2, 3]), rel=2e-3)
