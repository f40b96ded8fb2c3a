"""Scattering models: their tables reflect and transmit what the published equations integrate to."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import sunpeak as sp
from conftest import CommandLine

Floats = npt.NDArray[np.float64]
Value = Callable[[Floats, Floats], Floats]

SIDE = 32
"""Cells a side of the isotropic trees here: 16 rings of incidence."""


def hemisphere(up: float) -> tuple[Floats, Floats]:
    """Directions of a hemisphere and their weights cos(theta) d omega: Gauss in theta, equal steps in azimuth."""
    nodes, weights = np.polynomial.legendre.leggauss(140)
    theta = (nodes + 1) * math.pi / 4
    phi = (np.arange(360) + 0.5) * math.pi / 180
    t, p = np.meshgrid(theta, phi, indexing="ij")
    w = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), up * np.cos(t)], axis=-1).reshape(-1, 3)
    areas = weights[:, None] * math.pi / 4 * np.sin(t) * np.cos(t) * math.pi / 180
    return w, areas.reshape(-1)


UPPER, LOWER = hemisphere(1.0), hemisphere(-1.0)


def ring_albedo(value: Value, ring: int, up: float = 1.0, out: tuple[Floats, Floats] = UPPER) -> float:
    """Mean over a ring of incidence of what a model gives out."""
    edges = 1 - 2 * np.array([ring + 1, ring]) / SIDE
    nodes, weights = np.polynomial.legendre.leggauss(4)
    radii = edges.mean() + 0.5 * (edges[1] - edges[0]) * nodes
    sums = []
    for r in radii:
        light = np.broadcast_to([r, 0.0, up * math.sqrt(1 - r * r)], out[0].shape)
        sums.append(float(value(light, out[0]) @ out[1]))
    return float(np.average(sums, weights=weights * radii))


def mid_ring(ring: int, up: float) -> Floats:
    r = 1 - (2 * ring + 1) / SIDE
    return np.array([r, 0.0, up * math.sqrt(1 - r * r)])


def fresnel(cosine: Floats, index: float) -> Floats:
    """Textbook form by the refracted angle; total reflection is 1."""
    sine = np.sqrt(np.maximum(1 - cosine**2, 0)) / index
    inside = np.sqrt(np.maximum(1 - sine**2, 0))
    across = ((cosine - index * inside) / (cosine + index * inside)) ** 2
    along = ((inside - index * cosine) / (inside + index * cosine)) ** 2
    return np.where(sine >= 1, 1.0, (across + along) / 2)


def dot(a: Floats, b: Floats) -> Floats:
    return np.einsum("ij,ij->i", a, b)


def unit(v: Floats) -> Floats:
    return v / np.linalg.norm(v, axis=1)[:, None]


def phong(i: Floats, o: Floats) -> Floats:
    mirrored = i * [-1, -1, 1]
    return 0.3 / math.pi + 0.4 * 52 / (2 * math.pi) * np.maximum(dot(mirrored, o), 0) ** 50


def ward_angles(i: Floats, o: Floats, alpha: float) -> tuple[Floats, Floats]:
    h = unit(i + o)
    delta = np.arccos(np.clip(h[:, 2], -1, 1))
    return h, np.exp(-(np.tan(delta) ** 2) / alpha**2)


def ward(i: Floats, o: Floats) -> Floats:
    _, gauss = ward_angles(i, o, 0.2)
    return 0.1 / math.pi + 0.5 * gauss / (4 * math.pi * 0.2**2 * np.sqrt(i[:, 2] * o[:, 2]))


def wgmd(i: Floats, o: Floats) -> Floats:
    # By cosines: the squared length of i + o is 2 (1 + i.o), its height cos_i + cos_o.
    _, gauss = ward_angles(i, o, 0.2)
    return 0.1 / math.pi + 0.5 * gauss * 2 * (1 + dot(i, o)) / (math.pi * 0.2**2 * (i[:, 2] + o[:, 2]) ** 4)


def cook_torrance(i: Floats, o: Floats) -> Floats:
    m = 0.25
    h = unit(i + o)
    up, across = h[:, 2], dot(h, o)
    beckmann = np.exp((up**2 - 1) / (m * up) ** 2) / (math.pi * m**2 * up**4)
    grooves = np.minimum(1, np.minimum(2 * up * o[:, 2] / across, 2 * up * i[:, 2] / across))
    return 0.2 / math.pi + 0.8 * fresnel(across, 1.5) * beckmann * grooves / (4 * i[:, 2] * o[:, 2])


def ggx_parts(h: Floats, i: Floats, o: Floats, alpha: float) -> Floats:
    up = h[:, 2]
    theta = np.arccos(np.clip(up, -1, 1))
    d = alpha**2 / (math.pi * up**4 * (alpha**2 + np.tan(theta) ** 2) ** 2)

    def seen(w: Floats) -> Floats:
        return 2 / (1 + np.sqrt(1 + alpha**2 * (1 / w[:, 2] ** 2 - 1)))

    return d * seen(i) * seen(o)


def ggx_reflected(i: Floats, o: Floats) -> Floats:
    h = unit(i + o)
    return fresnel(dot(h, i), 1.5) * ggx_parts(h, i, o, 0.3) / (4 * i[:, 2] * o[:, 2])


def ggx_refracted(i: Floats, o: Floats) -> Floats:
    h = -unit(i + 1.5 * o)
    h = h * np.sign(h[:, 2])[:, None]
    ih, oh = dot(i, h), dot(o, h)
    refracted = 1.5**2 * (1 - fresnel(np.abs(ih), 1.5)) / (ih + 1.5 * oh) ** 2
    f = np.abs(ih * oh) / np.abs(i[:, 2] * o[:, 2]) * refracted * ggx_parts(h, i, o, 0.3)
    return np.where((ih > 0) & (oh < 0), f, 0.0)


MODELS = [
    (sp.Formula("phong", diffuse=0.3, specular=0.4, exponent=50), phong),
    (sp.Formula("ward", diffuse=0.1, specular=0.5, roughness=0.2), ward),
    (sp.Formula("wgmd", diffuse=0.1, specular=0.5, roughness=0.2), wgmd),
    (sp.Formula("cook-torrance", diffuse=0.2, specular=0.8, roughness=0.25), cook_torrance),
    (sp.Formula("ggx", index=1.5, roughness=0.3), ggx_reflected),
]


@pytest.mark.parametrize(("model", "value"), MODELS, ids=lambda m: getattr(m, "model", ""))
def test_tables_reflect_what_the_equations_integrate_to(model: sp.Formula, value: Value) -> None:
    bsdf = model.tabulate("t3", SIDE)
    for ring in [2, 6, 10, 15]:
        found = bsdf.hemispherical(mid_ring(ring, -1.0), "reflection")[0]
        assert found == pytest.approx(ring_albedo(value, ring), rel=5e-4), ring
    rng = np.random.default_rng(3)
    light, out = (sp.direction(rng.uniform(1, 85, 40), rng.uniform(0, 360, 40)) for _ in range(2))
    assert model.value(light, out) == pytest.approx(value(light, out), rel=1e-9)


def test_a_rough_face_refracts_what_the_equations_integrate_to() -> None:
    model = sp.Formula("rough-dielectric", index=1.5, roughness=0.3)
    bsdf = model.tabulate("t3", SIDE)
    for ring in [3, 9, 15]:
        # The file's front, in air, is the back of the frame.
        w_in = mid_ring(ring, -1.0)
        assert bsdf.hemispherical(w_in, "transmission")[0] == pytest.approx(
            ring_albedo(ggx_refracted, ring, out=LOWER), rel=1e-3
        )
        assert bsdf.hemispherical(w_in, "reflection")[0] == pytest.approx(ring_albedo(ggx_reflected, ring), rel=1e-3)
    light, out = sp.direction([30.0], [0.0]), sp.direction([160.0], [175.0])
    # Reciprocal but for the square of the index.
    assert model.value(light, out) == pytest.approx(1.5**2 * model.value(out, light), rel=1e-9)


def test_closed_forms(tmp_path: Path) -> None:
    normal = [0.0, 0.0, -1.0]
    lambert = sp.Formula("lambert", reflectance=0.6, transmittance=0.3).tabulate("klems-half")
    assert lambert.hemispherical(normal, "reflection") == pytest.approx(0.6, rel=1e-6)
    assert lambert.hemispherical(normal, "transmission") == pytest.approx(0.3, rel=1e-6)
    # Both faces of a pane at normal incidence, all orders: T = 2n / (n^2 + 1), R = 1 - T.
    glass = sp.Formula("glass", index=1.5).tabulate("t3", 128)
    truth = 3.0 / 3.25
    assert glass.through(normal) == pytest.approx(truth, rel=1e-3)
    assert glass.hemispherical(normal, "reflection") == pytest.approx(1 - truth, rel=2e-3)
    mirror = sp.Formula("mirror", reflectance=0.8).tabulate("klems-quarter")
    assert mirror.hemispherical(sp.direction([10, 40, 70, 140]), "reflection") == pytest.approx(0.8, rel=1e-6)
    # Phong at normal incidence gives out all of diffuse and specular: a table whose smallest rings are near it.
    lobe = sp.Formula("phong", diffuse=0.2, specular=0.5, exponent=200).tabulate("t3", 64)
    assert lobe.hemispherical([0.001, 0, -1.0], "reflection") == pytest.approx(0.7, rel=1e-3)


def test_an_anisotropic_lobe_lies_along_its_axes() -> None:
    model = sp.Formula("ward", diffuse=0.0, specular=0.5, roughness_x=0.1, roughness_y=0.4)
    bsdf = model.tabulate("klems-full")
    normal = [0.0, 0.0, 1.0]
    along_x, along_y = sp.direction([40, 40], [0, 90])
    assert bsdf.evaluate(normal, along_y)[0] > 20 * bsdf.evaluate(normal, along_x)[0]
    # Means of the formula over the pole patch and the patch at 40 degrees, by points.
    rng = np.random.default_rng(1)
    n = 200_000
    r = np.sin(np.radians(5)) * np.sqrt(rng.random(n))
    light = sp.direction(np.degrees(np.arcsin(r)), rng.uniform(0, 360, n))
    s2 = rng.uniform(np.sin(np.radians(35)) ** 2, np.sin(np.radians(45)) ** 2, n)
    out = sp.direction(np.degrees(np.arcsin(np.sqrt(s2))), rng.uniform(82.5, 97.5, n))
    assert bsdf.evaluate(normal, along_y)[0] == pytest.approx(float(model.value(light, out).mean()), rel=5e-3)
    with pytest.raises(sp.InputError, match="not the same at all azimuths"):
        model.tabulate("t3", 16)


def test_the_command_line_writes_models_and_refuses_what_they_are_not(sunpeak: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "paint.xml"
    sunpeak("bsdf", "formula", "wgmd", "-p", "specular=0.3", "-p", "roughness=0.2", "-o", path, "--name", "paint")
    about = sp.Bsdf.load(path).describe()
    assert about["name"] == "paint"
    assert "tabulated in klems by integration" in about["comments"]
    for wrong, status, message in [
        (("wgmd", "-p", "gloss=1"), 1, "has no 'gloss'"),
        (("wgmd", "-p", "specular=0.9", "-p", "diffuse=0.2"), 1, "add up to 1.1"),
        (("mirror", "-p", "reflectance=2"), 1, "expected 0 to 1"),
        (("mirror", "-p", "reflectance"), 2, "expected NAME=NUMBER"),
        (("mirror", "--basis", "t3"), 1, "expected cells a side"),
        (("ward", "-p", "roughness=nan"), 2, "finite"),
    ]:
        said = sunpeak("bsdf", "formula", *wrong, "-o", tmp_path / "x.xml", expect=status)
        assert message in said.err, (wrong, said.err)
    assert not (tmp_path / "x.xml").exists()
