"""Scans as a goniophotometer would give them of products in closed form."""

from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np
import numpy.typing as npt

import sunpeak as sp

Floats = npt.NDArray[np.float64]
Bsdf = Callable[[Floats, Floats], Floats]
"""BSDF [1/sr] of light from (3,) that leaves towards (n, 3)."""

FABRIC = sp.Fabric(openness=0.03, cut_off_deg=70.0, exponent=0.6)
"""T(theta) is known; what it scatters is `fabric_scatters`."""


def exits(around: Floats, *, step_deg: float = 3.0, fine_deg: float = 0.25) -> Floats:
    """Directions over the hemisphere on the side of `around`, and close ones around it (n, 3)."""
    sign = 1.0 if around[2] > 0 else -1.0
    theta = np.radians(np.arange(0.0, 87.0, step_deg))
    rings = [
        sp.direction(np.degrees(t), np.arange(n) * 360.0 / n + 1.7)
        for t in theta
        for n in [max(1, round(2 * np.pi * np.sin(t) / np.radians(step_deg)))]
    ]
    coarse = np.concatenate(rings) * [1.0, 1.0, sign]
    right = np.cross(around, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    up = np.cross(right, around)
    # Closer together towards the middle.
    angle = np.radians(np.concatenate([np.arange(0.0, 12, 1) * fine_deg, np.geomspace(12, 60, 16) * fine_deg]))[:, None]
    turn = np.radians(np.arange(0.0, 360.0, 15.0))[None, :]
    fine = (
        np.cos(angle)[..., None] * around
        + (np.sin(angle) * np.cos(turn))[..., None] * right
        + (np.sin(angle) * np.sin(turn))[..., None] * up
    ).reshape(-1, 3)
    return np.concatenate([coarse, fine[fine[:, 2] * sign > 0.02]])


def scan(
    bsdf: Bsdf, theta_deg: float, phi_deg: float, *, reflection: bool, noise: float = 0.0, **grid: float
) -> sp.Scan:
    """What is read of a BSDF at one incidence; relative `noise` of each reading."""
    light = sp.direction(theta_deg, phi_deg)
    middle = light * [-1.0, -1.0, 1.0] if reflection else -light
    out = exits(middle, **grid)
    random = np.random.default_rng([int(10 * theta_deg), int(10 * phi_deg)])
    return sp.Scan(light, out, bsdf(light, out) * (1.0 + noise * random.standard_normal(len(out))))


def scans(
    bsdf: Bsdf, thetas_deg: Iterable[float], phis_deg: Iterable[float] = (0.0,), *, reflection: bool, **how: float
) -> list[sp.Scan]:
    """Scans at all pairs of angles; the normal once."""
    pairs = [(t, p) for t in thetas_deg for k, p in enumerate(phis_deg) if t > 0 or k == 0]
    return [scan(bsdf, t, p, reflection=reflection, **how) for t, p in pairs]


def instrument(straight: Floats, out: Floats, fwhm_deg: float) -> Floats:
    """What an instrument makes of a sharp beam of unit flux: BSDF [1/sr]."""
    sigma = np.radians(fwhm_deg) / (2.0 * np.sqrt(2.0 * np.log(2.0)))
    angle = 2.0 * np.arcsin(np.clip(np.linalg.norm(out - straight, axis=-1) / 2.0, 0.0, 1.0))
    return np.exp(-0.5 * (angle / sigma) ** 2) / (2 * np.pi * sigma**2) / np.abs(out[..., 2])


def fabric_scatters(light: Floats, out: Floats, sigma: float = 0.25) -> Floats:
    """A diffuse part of 4 % and a lobe of 3 % around the straight direction, Gaussian on the disk."""
    squared = ((out[..., :2] + light[:2]) ** 2).sum(axis=-1)
    return 0.04 / np.pi + 0.03 * np.exp(-0.5 * squared / sigma**2) / (2 * np.pi * sigma**2)


def fabric(fwhm_deg: float, openness: Callable[[float], float] = FABRIC.through) -> Bsdf:
    """A woven fabric seen by an instrument."""

    def seen(light: Floats, out: Floats) -> Floats:
        through = openness(float(np.arccos(light[2])))
        return fabric_scatters(light, out) + through * instrument(-light, out, fwhm_deg)

    return seen


def hemispherical(bsdf: Bsdf, light: Floats, *, reflection: bool, rings: int = 600) -> float:
    """Integral of a smooth BSDF over the projected hemisphere on one side [-]: sums over even points."""
    radius = np.sqrt((np.arange(rings) + 0.5) / rings)[:, None]
    turn = (2 * np.pi * (np.arange(rings) + 0.5) / rings)[None, :]
    z = np.sqrt(1.0 - radius**2) * (1.0 if reflection else -1.0) * np.sign(light[2])
    out = np.stack(np.broadcast_arrays(radius * np.cos(turn), radius * np.sin(turn), z), axis=-1)
    return float(np.pi * bsdf(light, out.reshape(-1, 3)).mean())


def formula(model: sp.Formula) -> Bsdf:
    """A model's values."""
    return lambda light, out: model.value(np.broadcast_to(light, out.shape), out)


def write_pabopto(path: Path, scan: sp.Scan, quantity: str = "BSDF", up_deg: float = 90.0) -> Path:
    """A file of pab-opto's, as Radiance's manual of pabopto2bsdf has it, with "up" at another azimuth."""
    turn = up_deg - 90.0
    x, y, z = scan.to_light
    theta, phi = np.degrees(np.arccos(z)), np.degrees(np.arctan2(y, x)) + turn
    out = scan.exits
    values = scan.values * (np.abs(out[:, 2]) if quantity == "DSF" else 1.0)
    angles = np.degrees(np.arccos(np.clip(out[:, 2], -1, 1))), np.degrees(np.arctan2(out[:, 1], out[:, 0])) + turn
    head = [
        '#sample_name "weave"',
        f"#format: theta phi {quantity}",
        f"#incident_angle {theta:.6f} {phi % 360:.6f}",
        f"#intheta {theta:.6f}",
        f"#inphi {phi % 360:.6f}",
        f"#upphi {up_deg:g}",
        "#colorimetry: CIE-Y",
    ]
    rows = [f"{t:.6f} {p % 360:.6f} {v:.8g}" for t, p, v in zip(*angles, values, strict=True)]
    path.write_text("\n".join(head + rows) + "\n")
    return path
