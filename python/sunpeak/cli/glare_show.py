"""A glare report for people, on standard output."""

from rich import box
from rich.console import Console
from rich.table import Table

from sunpeak.glare_report import GlareReport

RATINGS = {
    "dgps": "DGPs",
    "edgps": "eDGPs",
    "dgi": "DGI",
    "dgi_modified": "DGI modified",
    "ugr": "UGR",
    "ugr_small_source": "UGR small sources",
    "ugp": "UGP 2014",
    "ugp_2017": "UGP 2017",
    "cgi": "CGI",
    "vcp": "VCP %",
    "dgr": "DGR",
    "pgsv": "PGSV",
    "pgsv_saturation": "PGSV saturation",
    "veiling_luminance_cd_m2": "veiling cd/m²",
}
"""Ratings and what people call them."""


def show(report: GlareReport) -> None:
    """Print the report."""
    console = Console(highlight=False)
    outside = "" if report.dgp_in_range else ", outside the range of DGP"
    console.print(f"DGP         [bold]{report.dgp:.3f}[/bold]  {report.glare_class}{outside}")
    for line in intervals(report):
        console.print(line)
    console.print(f"Ev          {report.ev_lux:.0f} lx, {report.ev_sources_lux:.0f} lx of it from glare sources")
    console.print(f"brightest   {report.max_luminance_cd_m2:.4g} cd/m²")
    console.print(
        f"mean        {report.mean_luminance_cd_m2:.4g} cd/m², median {report.median_luminance_cd_m2:.4g}, "
        f"background {report.background_cd_m2:.4g}"
    )
    console.print(f"zones       {zones(report)}")
    console.print(ratings(report))
    console.print(report.rule, style="dim", soft_wrap=True)
    if report.sources:
        console.print(sources(report))


def intervals(report: GlareReport) -> list[str]:
    """What is known of DGP and its class, where there is an interval."""
    lines = []
    for heading, known in (("sampling", report.sampling_intervals), ("input", report.input_intervals)):
        if known is not None:
            low, high = known["dgp"]
            ev_low, ev_high = known["ev_lux"]
            lines.append(f"  {heading:10}{low:.4f} to {high:.4f}, Ev {ev_low:.0f} to {ev_high:.0f} lx (95 %)")
    if lines:
        likely = {name: share for name, share in report.class_probabilities.items() if share >= 0.0005}
        shares = ", ".join(f"{name} {100 * share:.1f} %" for name, share in likely.items())
        lines.append(f"  class     [bold]{report.verdict}[/bold]: {shares}")
    return lines


def zones(report: GlareReport) -> str:
    """Mean luminances and their ratios, in a line."""
    means = {
        "task": report.zones.task_cd_m2,
        "ergorama": report.zones.ergorama_cd_m2,
        "panorama": report.zones.panorama_cd_m2,
        "periphery": report.zones.periphery_cd_m2,
    }
    ratios = report.zones.ratios_to_task()
    known = [f"{name} {mean:.4g} ({ratios[name]:.2g})" for name, mean in means.items() if mean is not None]
    return ", ".join(known) + " cd/m²"


def ratings(report: GlareReport) -> Table:
    """Table of the other ratings, several in a row."""
    table = Table.grid(padding=(0, 3))
    values = {name: getattr(report, key) for key, name in RATINGS.items()}
    known = [f"{name} [bold]{value:.4g}[/bold]" for name, value in values.items() if value is not None]
    for start in range(0, len(known), 4):
        table.add_row(*known[start : start + 4])
    return table


def sources(report: GlareReport) -> Table:
    """Table of the sources, the worst first."""
    table = Table(box=box.SIMPLE_HEAD)
    headings = ["", "cd/m²", "sr", "° off sight", "P", "lx", "of DGP", "pixels"]
    for heading in headings:
        table.add_column(heading, justify="right")
    for number, source in enumerate(report.sources, 1):
        table.add_row(
            str(number),
            f"{source.luminance_cd_m2:.4g}",
            f"{source.solid_angle_sr:.3g}",
            f"{source.angle_to_sight_deg:.1f}",
            f"{source.position_index:.2f}",
            f"{source.illuminance_lux:.1f}",
            f"{source.dgp_part:.4f}",
            "exact" if source.exact else str(source.pixels),
        )
    return table
