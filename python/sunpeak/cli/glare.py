"""`sunpeak glare`: glare numbers of a picture."""

from typing import Annotated

import typer

from sunpeak.cli import glare_compare, glare_draw
from sunpeak.cli import glare_options as options
from sunpeak.cli.default_command import DEFAULT, DefaultCommandGroup
from sunpeak.cli.glare_show import show
from sunpeak.cli.output import emit_json, note
from sunpeak.comfort import glare
from sunpeak.pictures import Picture

app = typer.Typer(cls=DefaultCommandGroup, help="Glare numbers of a picture.", rich_markup_mode="rich")
app.command("compare")(glare_compare.command)
app.command("draw")(glare_draw.command)


@app.command(DEFAULT)
def command(
    picture: options.PictureFile,
    rules: options.Rules = "sunpeak",
    threshold: options.Threshold = None,
    times_mean: options.TimesMean = None,
    times_task: options.TimesTask = None,
    task: options.TaskZone = None,
    search_angle: options.SearchAngle = None,
    peak_luminance: options.PeakLuminance = None,
    least_solid_angle: options.LeastSolidAngle = None,
    below_sight: options.BelowSightOption = None,
    ev: Annotated[
        float | None, typer.Option(metavar="LUX", help="Vertical illuminance.", rich_help_panel=options.SEEN)
    ] = None,
    source_distance: Annotated[
        float | None,
        typer.Option(
            metavar="M", help="How far away sources are, for UGR of small ones.", rich_help_panel=options.SEEN
        ),
    ] = None,
    through: options.Through = None,
    sky: options.Sky = None,
    position: options.Position = 0.0,
    low_light: Annotated[bool, typer.Option("--low-light", help="Lower DGP in dim scenes (Wienold 2012).")] = False,
    relative_error: Annotated[float, typer.Option(help="Standard error of the picture, for the interval.")] = 0.0,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON object on standard output.")] = False,
) -> None:
    """Vertical illuminance, daylight glare probability and other glare ratings of a picture.

    Suns that the picture knows exactly count with their own size. `sunpeak glare compare A.hdr B.hdr` says why a number
    changed, `sunpeak glare draw PICTURE` shows the sources.

    [dim]$[/dim] [cyan]sunpeak glare out.hdr[/cyan]
    """
    if sum(value is not None for value in (threshold, times_mean, times_task)) > 1:
        raise typer.BadParameter("--threshold, --times-mean and --times-task exclude each other")
    if times_task is not None and task is None:
        raise typer.BadParameter("--times-task needs --task")
    loaded = Picture.load(picture)
    zone = options.task_of(loaded, task)
    report = glare(
        loaded,
        rules=rules,
        threshold_cd_m2=threshold,
        threshold_times_mean=times_mean,
        threshold_times_task=None if times_task is None or zone is None else (times_task, zone),
        search_angle_rad=search_angle,
        peak_cd_m2=options.peak_of(peak_luminance),
        least_solid_angle_sr=least_solid_angle,
        below_sight=below_sight,
        task=zone,
        ev_lux=ev,
        source_distance_m=source_distance,
        low_light=low_light,
        tolerance_through=through or 0.0,
        tolerance_sky=sky or 0.0,
        tolerance_position_deg=position,
        relative_error=relative_error,
    )
    for warning in report.warnings:
        note(f"sunpeak: warning: {warning}")
    if as_json:
        emit_json(report.to_dict())
    else:
        show(report)
