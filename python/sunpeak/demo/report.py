"""The demo's report: one HTML file that needs nothing beside it."""

import base64
import html
from importlib import resources
from string import Template

import numpy as np

from sunpeak import __version__
from sunpeak.demo.room import DEMO_ROOM
from sunpeak.images import colours, exposure_of, false_colour, luminance_cd_m2, png_bytes, seen, tonemap
from sunpeak.rooms import FABRIC, Case, Expectation, Pair

SCALE_CD_M2 = (10.0, 1e7)
"""Ends of the false-colour scale, the same for all pictures."""

CLOSE_UP_ZOOM = 2
"""Screen pixels along each side of a pixel of the close-ups."""


def report_html(pairs: list[Pair], expected: Expectation, *, made_by: str) -> str:
    """Write the report."""
    template = Template(resources.files("sunpeak.demo").joinpath("report.html").read_text(encoding="utf-8"))
    exposure = exposure_of(luminance_cd_m2(pairs[0].without.pixels))
    return template.substitute(
        version=html.escape(__version__),
        made_by=html.escape(made_by),
        table="\n".join(table_row(pair, expected) for pair in pairs),
        gallery="\n".join(gallery_row(pair, exposure) for pair in pairs),
        scale=scale_css(),
        ticks=scale_ticks(),
        openness=f"{100 * FABRIC.openness:g}",
        cut_off=f"{FABRIC.cut_off_deg:g}",
        incidence=f"{expected.incidence_deg:.1f}",
        share=f"{100 * expected.incidence_deg / FABRIC.cut_off_deg:.0f}",
        fabric=f"{expected.fabric_transmittance:.5f}",
        glazing=f"{expected.glazing_transmittance:.4f}",
        sun=quantity(expected.sun_cd_m2),
        expected=quantity(expected.luminance_cd_m2),
        altitude=f"{DEMO_ROOM.sun.altitude_deg:g}",
        azimuth=f"{DEMO_ROOM.sun.azimuth_deg:g}",
        direct=f"{DEMO_ROOM.direct_normal_w_m2:g}",
        diffuse=f"{DEMO_ROOM.diffuse_horizontal_w_m2:g}",
        panes=str(DEMO_ROOM.glazing.panes),
        dgp_spread=f"{spread([pair.with_peak.dgp for pair in pairs if pair.with_peak.basis != 'klems']):.3f}",
        low_dgp=f"{min(pair.without.dgp for pair in pairs):.3f}",
        high_dgp=f"{max(pair.without.dgp for pair in pairs):.3f}",
    )


def spread(values: list[float]) -> float:
    """Largest less smallest; 0 of nothing."""
    return max(values, default=0.0) - min(values, default=0.0)


def quantity(value: float) -> str:
    """Write a number with thin spaces between thousands, four figures exact."""
    if value == 0:
        return "0"
    digits = max(0, 4 - 1 - int(np.floor(np.log10(abs(value)))))
    magnitude = 10.0 ** max(0, int(np.floor(np.log10(abs(value)))) - 3)
    return f"{round(value / magnitude) * magnitude:,.{digits}f}".replace(",", "\u202f")


def table_row(pair: Pair, expected: Expectation) -> str:
    """Write one basis: illuminance, DGP and brightest luminance without and with peak extraction."""
    without, with_peak = pair.without, pair.with_peak
    ratio = with_peak.max_luminance_cd_m2 / expected.luminance_cd_m2 - 1.0
    cells = [
        f"{without.ev_lux:.0f}",
        f"{without.dgp:.3f}",
        quantity(without.max_luminance_cd_m2),
        f"{with_peak.ev_lux:.0f}",
        f"<b>{with_peak.dgp:.3f}</b>",
        quantity(with_peak.max_luminance_cd_m2),
        f"{100 * ratio:+.2f} %",
    ]
    return f"<tr><th>{pair.label}</th>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>"


def gallery_row(pair: Pair, exposure: float) -> str:
    """Write the two pictures of a basis side by side."""
    figures = "".join(figure(case, exposure) for case in (pair.without, pair.with_peak))
    return f'<section><h3>{pair.label}</h3><div class="pair">{figures}</div></section>'


def figure(case: Case, exposure: float) -> str:
    """Write one picture, tone-mapped and in false colours, with the close-up of the sun."""
    luminance = luminance_cd_m2(case.pixels)
    shown = seen(luminance.shape)
    mapped = tonemap(case.pixels, exposure)
    mapped[~shown] = 255
    near = false_colour(luminance_cd_m2(case.close_up), SCALE_CD_M2)
    near = near.repeat(CLOSE_UP_ZOOM, axis=0).repeat(CLOSE_UP_ZOOM, axis=1)
    peak = "with peak extraction" if case.peak != "off" else "without peak extraction"
    numbers = f"E<sub>v</sub> {case.ev_lux:.0f} lx · DGP {case.dgp:.3f}"
    return f"""
<figure>
  <figcaption><b>{peak}</b><span>{numbers}</span></figcaption>
  <div class="view">
    {picture(mapped, f"{pair_name(case)}, tone-mapped", "mapped")}
    {picture(false_colour(luminance, SCALE_CD_M2, shown), f"{pair_name(case)}, false colours", "false")}
    {picture(near, f"{pair_name(case)}, the sun close up", "near")}
  </div>
</figure>"""


def pair_name(case: Case) -> str:
    """Describe a picture to who cannot see it."""
    return f"fisheye view, {case.basis}, peak {case.peak}"


def picture(image: np.ndarray, text: str, kind: str) -> str:
    """Write an image into the page itself."""
    data = base64.b64encode(png_bytes(image)).decode()
    return f'<img class="{kind}" alt="{html.escape(text)}" src="data:image/png;base64,{data}">'


def scale_css() -> str:
    """Write the colours of the scale as stops of a gradient."""
    stops = np.round(255 * colours(np.linspace(0, 1, 17))).astype(int)
    return ", ".join(f"rgb({r} {g} {b})" for r, g, b in stops)


def scale_ticks() -> str:
    """Write the decades under the scale."""
    low, high = (round(np.log10(end)) for end in SCALE_CD_M2)
    return "".join(f"<span>10<sup>{decade}</sup></span>" for decade in range(low, high + 1))
