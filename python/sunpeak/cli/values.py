"""Values of options that are not plain numbers; what is wrong with them is wrong usage (exit status 2)."""

import math
import re
from datetime import datetime
from typing import Literal

import typer

from sunpeak.skies import Place


def parse_size(text: str) -> tuple[int, int]:
    """`800x600` or `800`, as width and height in pixels."""
    match = re.fullmatch(r"(\d+)(?:[xX](\d+))?", text.strip())
    if match is None:
        raise typer.BadParameter(f"{text!r}; expected WIDTHxHEIGHT, as in 800x600")
    width = int(match[1])
    height = int(match[2]) if match[2] else width
    if not (width and height):
        raise typer.BadParameter(f"{text!r}; a picture needs at least one pixel each way")
    return width, height


def parse_numbers(text: str) -> list[float]:
    """`0,10,20` as numbers."""
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError as error:
        raise typer.BadParameter(f"{text!r}; expected numbers with commas between, as in 0,10,20") from error
    if not all(math.isfinite(number) for number in numbers):
        raise typer.BadParameter(f"{text!r}; expected finite numbers")
    return numbers


def parse_percent(text: str) -> float:
    """`1` or `1%` as 0.01."""
    try:
        percent = float(text.strip().removesuffix("%"))
    except ValueError as error:
        raise typer.BadParameter(f"{text!r}; expected a percentage, as in 1 or 0.5%") from error
    if not (math.isfinite(percent) and percent > 0):
        raise typer.BadParameter(f"{text!r}; expected a positive percentage")
    return percent / 100


def parse_colour(text: str) -> tuple[float, float, float]:
    """`#8a6f4d`, a colour as screens show it (sRGB), or `0.25,0.16,0.08`, as linear red, green and blue."""
    if re.fullmatch(r"#[0-9a-fA-F]{6}", text.strip()):
        red, green, blue = (_linear(int(text.strip()[at : at + 2], 16) / 255) for at in (1, 3, 5))
    else:
        try:
            red, green, blue = (float(part) for part in text.split(","))
        except ValueError as error:
            raise typer.BadParameter(f"{text!r}; expected #RRGGBB, or red,green,blue as in 0.25,0.16,0.08") from error
    if not (min(red, green, blue) >= 0 and 0 < max(red, green, blue) < math.inf):
        raise typer.BadParameter(f"{text!r}; expected numbers of 0 or more, not all of them 0")
    return red, green, blue


def _linear(value: float) -> float:
    """Undo the transfer function of sRGB (IEC 61966-2-1)."""
    linear: float = value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
    return linear


def parse_share(text: str) -> float:
    """`3%` or `0.03` as 0.03."""
    try:
        share = float(text.strip().removesuffix("%")) / (100 if text.strip().endswith("%") else 1)
    except ValueError as error:
        raise typer.BadParameter(f"{text!r}; expected a share, as in 3% or 0.03") from error
    if not 0 <= share <= 1:
        raise typer.BadParameter(f"{text!r}; expected a share of the light, from 0 to 100%, as in 3% or 0.03")
    return share


def parse_length(text: str) -> float:
    """`0.4mm`, `0.0004m` or `0.0004` as metres."""
    match = re.fullmatch(r"([0-9.eE+-]+) *(mm|cm|m)?", text.strip())
    try:
        length = float(match[1]) * {"mm": 1e-3, "cm": 1e-2}.get(match[2] or "m", 1.0) if match else math.nan
    except ValueError:
        length = math.nan
    if not 0 <= length < math.inf:
        raise typer.BadParameter(f"{text!r}; expected a length, as in 0.4mm or 0.0004 (metres)")
    return length


def parse_goal(text: str) -> float | Literal["class"] | tuple[Literal["dgp", "ev"], float]:
    """`1` or `1%` as 0.01; `class`; `dgp:0.005`; `ev:1%` as `("ev", 0.01)`."""
    kind, colon, value = text.strip().partition(":")
    if kind == "class" and not colon:
        return "class"
    if kind == "ev" and colon:
        return "ev", parse_percent(value)
    if kind == "dgp" and colon:
        numbers = parse_numbers(value)
        if len(numbers) == 1 and numbers[0] > 0:
            return "dgp", numbers[0]
    elif not colon:
        return parse_percent(text)
    raise typer.BadParameter(f"{text!r}; expected a percentage, class, dgp:0.005 or ev:1%")


def parse_place(text: str) -> Place:
    """`37.7,-122.2` or with the elevation in metres, as a place."""
    numbers = parse_numbers(text)
    if len(numbers) not in (2, 3) or not (abs(numbers[0]) <= 90 and abs(numbers[1]) <= 180):
        raise typer.BadParameter(f"{text!r}; expected LATITUDE,LONGITUDE[,METRES], degrees north and east")
    return Place(*numbers)


def parse_time(text: str) -> datetime:
    """`2024-06-21T14:30+02:00` as a time."""
    try:
        when = datetime.fromisoformat(text)
    except ValueError as error:
        raise typer.BadParameter(f"{text!r}; expected a time as in 2024-06-21T14:30+02:00") from error
    if when.tzinfo is None:
        raise typer.BadParameter(f"{text!r}; expected a time zone at its end, as in {text}+01:00")
    return when


def parse_instrument(text: str) -> float | Literal["find"]:
    """`1.5` as degrees, or `find`."""
    return "find" if text.strip() == "find" else _width(text, ", or find")


def parse_width(text: str) -> float:
    """`1.5` as degrees."""
    return _width(text, "")


def _width(text: str, otherwise: str) -> float:
    """Width of an instrument [deg]; `otherwise` is what else would be allowed."""
    try:
        width = float(text)
    except ValueError as error:
        raise typer.BadParameter(f"{text!r}; expected degrees, as in 1.5{otherwise}") from error
    if not 0.05 <= width <= 20.0:
        raise typer.BadParameter(f"{text!r}; expected 0.05 to 20 degrees{otherwise}")
    return width
