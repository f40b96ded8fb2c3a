"""`sunpeak bsdf fabric`: a fabric from its datasheet or from a formula."""

from dataclasses import fields, replace
from pathlib import Path
from typing import Annotated, Any

import typer

from sunpeak._core import InputError
from sunpeak.bands import Label
from sunpeak.cli.bsdf_convert import Manufacturer, Name, Thickness
from sunpeak.cli.options import Quiet
from sunpeak.cli.output import emit, note
from sunpeak.cli.run import Resume, running
from sunpeak.cli.values import parse_colour, parse_share
from sunpeak.fabrics import Fabric, RollerBlind
from sunpeak.glare_control import CAVEAT, MEANINGS

DATASHEET = "From a datasheet (EN 14500)"
FORMULA = "From a formula"


def _share(name: str, text: str, panel: str, default: str | bool = False) -> Any:
    """Declare an option that takes `3%` or `0.03`."""
    return typer.Option(
        name, parser=parse_share, metavar="SHARE", help=text, rich_help_panel=panel, show_default=default
    )


def _default(name: str) -> str:
    return next(f"{field.default:g}" for field in fields(Fabric) if field.name == name)


def fabric(
    output: Annotated[Path, typer.Option("--output", "-o", help="LBNL XML file to write.")],
    basis: Annotated[
        str, typer.Option(help="klems, klems-half, klems-quarter, or t3-1024 … t3-16384, t4-256 …, by number of cells.")
    ] = "klems",
    cut_off: Annotated[
        float | None,
        typer.Option(
            help="Degrees from which nothing goes straight through.",
            show_default=f"by the openness from a datasheet, {Fabric.cut_off_deg:g} from a formula",
        ),
    ] = None,
    tau_nn: Annotated[Any, _share("--tau-nn", "Normal-normal transmittance: straight through.", DATASHEET)] = None,
    tau_nh: Annotated[Any, _share("--tau-nh", "Normal-hemispherical transmittance: in all.", DATASHEET)] = None,
    rho_front: Annotated[Any, _share("--rho-front", "Reflectance of the side towards the sun.", DATASHEET)] = None,
    rho_back: Annotated[
        Any, _share("--rho-back", "Reflectance of the side towards the room.", DATASHEET, "as the front")
    ] = None,
    solar_tau_nn: Annotated[
        Any, _share("--solar-tau-nn", "Solar: straight through.", DATASHEET, "as --tau-nn: holes have no colour")
    ] = None,
    solar_tau_nh: Annotated[Any, _share("--solar-tau-nh", "Solar: in all. Writes both bands.", DATASHEET)] = None,
    solar_rho_front: Annotated[Any, _share("--solar-rho-front", "Solar: towards the sun.", DATASHEET)] = None,
    solar_rho_back: Annotated[
        Any, _share("--solar-rho-back", "Solar: towards the room.", DATASHEET, "as the front")
    ] = None,
    colour: Annotated[
        Any,
        typer.Option(
            parser=parse_colour,
            metavar="#RRGGBB|R,G,B",
            help="Of the threads, as on a screen (sRGB) or linear: tints what is scattered and reflected (visible).",
            rich_help_panel=DATASHEET,
        ),
    ] = None,
    split: Annotated[
        Path | None,
        typer.Option(
            help="Folder for the exact straight-through part beside the rest (visible).", rich_help_panel=DATASHEET
        ),
    ] = None,
    openness: Annotated[
        Any, _share("--openness", "Straight through at normal incidence.", FORMULA, _default("openness"))
    ] = None,
    exponent: Annotated[
        float | None,
        typer.Option(
            help="Steepness of the fall to the cut-off.", rich_help_panel=FORMULA, show_default=_default("exponent")
        ),
    ] = None,
    scattered: Annotated[Any, _share("--scattered", "Scattered.", FORMULA, _default("scattered"))] = None,
    lobe_share: Annotated[
        Any, _share("--lobe-share", "Share of it around the straight direction.", FORMULA, _default("lobe_share"))
    ] = None,
    lobe_sigma: Annotated[
        float | None,
        typer.Option(
            help="Width of that lobe, projected.", rich_help_panel=FORMULA, show_default=_default("lobe_sigma")
        ),
    ] = None,
    reflectance: Annotated[
        Any, _share("--reflectance", "Diffuse, both sides.", FORMULA, _default("reflectance"))
    ] = None,
    name: Name = None,
    manufacturer: Manufacturer = None,
    thickness: Thickness = None,
    resume: Resume = False,
    quiet: Quiet = False,
) -> None:
    """Make a fabric from a datasheet or from a formula.

    Datasheet: a roller blind by the model of Kotey, Wright and Collins (2009). Formula: T = openness cos(90 deg theta /
    cut-off)^exponent, a lobe around the straight direction, and diffuse light.

    For a datasheet the glare-control class of EN 14501:2005 is printed.

    [dim]$[/dim] [cyan]sunpeak bsdf fabric -o blind.xml --tau-nn 3% --tau-nh 5% --rho-front 40% --rho-back 35%[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf fabric -o red.xml --tau-nn 3% --tau-nh 5% --rho-front 9% --colour '#8a4d4d'[/cyan]

    [dim]$[/dim] [cyan]sunpeak bsdf fabric -o shade.xml --basis t3-4096 --openness 3%[/cyan]
    """
    formula = {
        "exponent": exponent,
        "scattered": scattered,
        "lobe_share": lobe_share,
        "lobe_sigma": lobe_sigma,
        "reflectance": reflectance,
    }
    given = {key: value for key, value in formula.items() if value is not None}
    label = Label(name, manufacturer, thickness)
    solar = (solar_tau_nn, solar_tau_nh, solar_rho_front, solar_rho_back)
    if tau_nn is None and tau_nh is None and rho_front is None and rho_back is None:
        if any(value is not None for value in (split, colour, *solar)):
            raise typer.BadParameter(
                "--split, --colour and --solar-…: for fabrics from a datasheet; expected --tau-nn and --tau-nh"
            )
        known = {"openness": openness, "cut_off_deg": cut_off}
        given |= {key: value for key, value in known.items() if value is not None}
        with running(output, resume, quiet) as run:
            Fabric(**given).write(output, basis, label=label, run=run)
        return
    if given:
        names = ", ".join("--" + name.replace("_", "-") for name in given)
        raise typer.BadParameter(
            f"{names}: for fabrics from a formula; expected none of it beside a datasheet's numbers"
        )
    visible = replace(_of_datasheet(tau_nn, tau_nh, rho_front, rho_back, openness, cut_off, quiet), colour=colour)
    beside = _solar(visible, *solar)
    with running(output, resume, quiet) as run:
        visible.write(output, basis, solar=beside, split=split, label=label, run=run)
    reached = visible.glare_control_class()
    emit(f"glare control: class {reached}, {MEANINGS[reached]} (EN 14501:2005)\n")
    note(CAVEAT, quiet)


def _solar(
    visible: RollerBlind,
    tau_nn: float | None,
    tau_nh: float | None,
    rho_front: float | None,
    rho_back: float | None,
) -> RollerBlind | None:
    """Put the solar values together; what goes through holes is the same at all wavelengths."""
    if tau_nn is None and tau_nh is None and rho_front is None and rho_back is None:
        return None
    if tau_nh is None or rho_front is None:
        raise typer.BadParameter("solar values need --solar-tau-nh and --solar-rho-front")
    sheet = RollerBlind(
        visible.tau_nn if tau_nn is None else tau_nn,
        tau_nh,
        rho_front,
        rho_front if rho_back is None else rho_back,
        visible.cut_off(),
    )
    try:
        sheet.cut_off()
    except InputError as error:
        raise InputError(f"solar values: {error}") from error
    return sheet


def _of_datasheet(
    tau_nn: float | None,
    tau_nh: float | None,
    rho_front: float | None,
    rho_back: float | None,
    openness: float | None,
    cut_off: float | None,
    quiet: bool,
) -> RollerBlind:
    if tau_nh is None or rho_front is None:
        raise typer.BadParameter("a datasheet's fabric needs --tau-nn, --tau-nh and --rho-front")
    if tau_nn is not None and openness is not None:
        raise typer.BadParameter("--tau-nn and --openness: expected one of them")
    if tau_nn is None:
        if openness is None:
            raise typer.BadParameter("a datasheet's fabric needs --tau-nn; or --openness, if nothing else is known")
        note(
            f"warning: the nominal openness, {100 * openness:g} %, is taken for --tau-nn; the normal-normal "
            "transmittance that is measured may differ from it by half",
            quiet,
        )
        tau_nn = openness
    return RollerBlind(tau_nn, tau_nh, rho_front, rho_front if rho_back is None else rho_back, cut_off)
