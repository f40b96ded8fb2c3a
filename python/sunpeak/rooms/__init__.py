"""Rooms of our own behind a fabric in closed form, rendered without and with peak extraction."""

from sunpeak.rooms.closed_form import Expectation, expectation
from sunpeak.rooms.experiment import Plan, cases
from sunpeak.rooms.fabric import BASES, FABRIC, LABELS, write_fabric
from sunpeak.rooms.results import Case, Pair, pairs
from sunpeak.rooms.room import Glazing, Room

__all__ = [
    "BASES",
    "FABRIC",
    "LABELS",
    "Case",
    "Expectation",
    "Glazing",
    "Pair",
    "Plan",
    "Room",
    "cases",
    "expectation",
    "pairs",
    "write_fabric",
]
