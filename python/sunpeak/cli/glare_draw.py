"""`sunpeak glare draw`: pictures about glare."""

from pathlib import Path
from typing import Annotated

import typer

from sunpeak.cli import glare_options as options
from sunpeak.cli.output import note
from sunpeak.comfort import glare
from sunpeak.files import check_target
from sunpeak.glare_draw import panel, save_glare
from sunpeak.glare_rules import RULES, Stated
from sunpeak.pictures import Picture


def command(
    pictures: Annotated[list[Path], typer.Argument(metavar="A.hdr …", help="One picture, or several side by side.")],
    output: Annotated[
        list[Path], typer.Option("--output", "-o", metavar="FILE", help="PNG or SVG to write; may come again.")
    ],
    position_index: Annotated[
        bool, typer.Option("--position-index", help="Lines of equal position index, too.")
    ] = False,
    rules: options.Rules = "sunpeak",
    threshold: options.Threshold = None,
    task: options.TaskZone = None,
) -> None:
    """Draw luminance in false colours, the sources outlined and numbered as in `sunpeak glare`.

    [dim]$[/dim] [cyan]sunpeak glare draw without.hdr with.hdr -o both.png -o both.svg[/cyan]
    """
    for target in output:
        check_target(target)
    panels = []
    zone = None
    for path in pictures:
        picture = Picture.load(path)
        zone = options.task_of(picture, task)
        stated: Stated = {"threshold_cd_m2": threshold, "task": zone}
        report = glare(picture, rules=rules, **stated)
        for warning in report.warnings:
            note(f"sunpeak: warning: {path}: {warning}")
        panels.append(panel(picture, report, path.stem, RULES[rules], **stated))
    save_glare(panels, *output, task=zone, position_index=position_index, rules=RULES[rules])
