"""`sunpeak bsdf measured`: a BSDF from goniophotometer scans."""

from pathlib import Path
from typing import Annotated, Any

import typer

from sunpeak.cli.bsdf_convert import Manufacturer, Name, Thickness
from sunpeak.cli.options import Quiet
from sunpeak.cli.output import note
from sunpeak.cli.run import Resume, running
from sunpeak.cli.values import parse_width
from sunpeak.measurement import Energy, Symmetry, measured_bsdf

SAMPLE = "What was measured"
TABLES = "What is written"


def measured(
    scans: Annotated[
        list[Path], typer.Argument(metavar="SCAN…", help="Files of scans: pab-opto, columns as ASTM E1392, CSV.")
    ],
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    basis: Annotated[
        str,
        typer.Option(
            help="klems-full, klems-half, klems-quarter, t3, t4; or t3-4096, t4-256 … by cells.",
            rich_help_panel=TABLES,
        ),
    ] = "klems-full",
    resolution: Annotated[
        int | None, typer.Option(help="Cells a side of t3 and t4: 8, 16, 32, 64, 128.", rich_help_panel=TABLES)
    ] = None,
    symmetry: Annotated[
        Symmetry, typer.Option(help="Of the sample; found by the azimuths of incidence.", rich_help_panel=SAMPLE)
    ] = "find",
    instrument_fwhm: Annotated[
        Any,
        typer.Option(
            parser=parse_width,
            metavar="DEG",
            help="Full width at half maximum of what the instrument makes of a sharp beam: such a lobe in the straight "
            "direction becomes an exact peak.",
            rich_help_panel=SAMPLE,
        ),
    ] = None,
    beam: Annotated[
        Path | None,
        typer.Option(metavar="SCAN", help="A scan of the bare beam, to take that from.", rich_help_panel=SAMPLE),
    ] = None,
    energy: Annotated[
        Energy,
        typer.Option(help="Where more light leaves than comes in.", rich_help_panel=SAMPLE),
    ] = "refuse",
    split: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Write the exact split there, too.", rich_help_panel=TABLES),
    ] = None,
    name: Name = None,
    manufacturer: Manufacturer = None,
    thickness: Thickness = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Make a BSDF of goniophotometer scans; whatever sides and modes they have become tables.

    [dim]$[/dim] [cyan]sunpeak bsdf measured fabric_*.txt -o fabric.xml --basis t3 --resolution 64[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf measured fabric.csv -o fabric.xml --instrument-fwhm 1.5 --split fabric[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf measured screen.csv -o screen.xml --beam empty.txt --symmetry bilateral[/cyan]
    """
    with running(output, resume, quiet) as run:
        made = measured_bsdf(
            scans,
            basis,
            resolution=resolution,
            symmetry=symmetry,
            instrument_fwhm_deg=instrument_fwhm,
            beam=beam,
            energy=energy,
            run=run,
        )
        made.save(output, name=name, manufacturer=manufacturer, thickness_m=thickness)
    note(made.summary(), quiet)
    if split is not None:
        for written in made.save_split(split):
            note(str(written), quiet)
