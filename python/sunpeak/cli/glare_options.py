"""Options of how glare sources are found, shared by the commands about glare."""

from pathlib import Path
from typing import Annotated, Any

import typer

from sunpeak.cli.values import parse_numbers, parse_percent
from sunpeak.glare_rules import BelowSight, RulesName, Task
from sunpeak.pictures import Picture

SEARCH = "How sources are found"
SEEN = "What the picture does not say"
TOLERANCES = "How well the input is known (half-widths of 95 % intervals)"


def parse_task(text: str) -> tuple[float, float, float]:
    """`0,-20,30`: degrees to the right, degrees up, full opening angle."""
    numbers = parse_numbers(text)
    if len(numbers) != 3 or numbers[2] <= 0:
        raise typer.BadParameter(f"{text!r}; expected RIGHT,UP,OPENING in degrees, as in 0,-20,30")
    return numbers[0], numbers[1], numbers[2]


PictureFile = Annotated[Path, typer.Argument(help="Fisheye picture, Radiance format, with VIEW= in its header.")]
Rules = Annotated[RulesName, typer.Option(help="Whose answers to what is open.", rich_help_panel=SEARCH)]
Threshold = Annotated[
    float | None,
    typer.Option(metavar="CD/M2", help="Luminance above which a pixel may glare (2000).", rich_help_panel=SEARCH),
]
TimesMean = Annotated[
    float | None,
    typer.Option(help="Instead: so many times the mean luminance of the view.", rich_help_panel=SEARCH),
]
TimesTask = Annotated[
    float | None,
    typer.Option(help="Instead: so many times the mean luminance of the task zone.", rich_help_panel=SEARCH),
]
TaskZone = Annotated[
    Any,
    typer.Option(
        "--task",
        parser=parse_task,
        metavar="RIGHT,UP,OPENING",
        help="Round task zone: degrees from the line of sight, full angle.",
        rich_help_panel=SEARCH,
    ),
]
SearchAngle = Annotated[
    float | None,
    typer.Option(metavar="RAD", help="Opening angle within which pixels are one source (0.2).", rich_help_panel=SEARCH),
]
PeakLuminance = Annotated[
    float | None,
    typer.Option(
        metavar="CD/M2",
        help="Pixels above this are sources of their own (50000); 0: none are.",
        rich_help_panel=SEARCH,
    ),
]
LeastSolidAngle = Annotated[
    float | None,
    typer.Option(metavar="SR", help="Smaller sources count as if they had this size.", rich_help_panel=SEARCH),
]
BelowSightOption = Annotated[
    BelowSight | None,
    typer.Option("--below-sight", help="Position index below the line of sight.", rich_help_panel=SEARCH),
]


Through = Annotated[
    Any,
    typer.Option(
        "--through",
        parser=parse_percent,
        metavar="PCT",
        help="Through transmittance or openness, in percent of itself.",
        rich_help_panel=TOLERANCES,
    ),
]
Sky = Annotated[
    Any,
    typer.Option("--sky", parser=parse_percent, metavar="PCT", help="Sky and sun.", rich_help_panel=TOLERANCES),
]
Position = Annotated[
    float,
    typer.Option("--position", metavar="DEG", help="Where sources stand in the view.", rich_help_panel=TOLERANCES),
]


def task_of(picture: Picture, numbers: tuple[float, float, float] | None) -> Task | None:
    """Place the task zone in the world."""
    return None if numbers is None else Task.at(picture.view, *numbers)


def peak_of(luminance: float | None) -> Any:
    """What `glare` calls it: `"rules"` where nothing is stated, `None` for 0."""
    return "rules" if luminance is None else luminance or None
