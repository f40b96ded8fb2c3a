"""Tables in Markdown."""

from collections.abc import Callable
from typing import TypeVar

About = TypeVar("About")
"""What a row is about."""
Column = tuple[str, Callable[[About], str]]


def table_of(columns: list[Column[About]], rows: list[About]) -> str:
    """A table, without the columns that no row fills."""
    shown = [(title, [cell(row) for row in rows]) for title, cell in columns]
    shown = [(title, cells) for title, cells in shown if any(cell != "-" for cell in cells)]
    lines = ["| " + " | ".join(title for title, _ in shown) + " |", "|" + "---|" * len(shown)]
    lines += ["| " + " | ".join(cells) + " |" for cells in zip(*(cells for _, cells in shown), strict=True)]
    return "\n".join(lines)


def text_table(headings: tuple[str, ...], rows: list[list[str]]) -> str:
    """A table of what is text already."""
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def spaced(value: float) -> str:
    """A whole number with spaces between thousands."""
    return f"{value:,.0f}".replace(",", " ")
