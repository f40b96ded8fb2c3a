"""`sunpeak demo`: a room behind a fabric, without and with peak extraction, from four tables of the fabric."""

from sunpeak.demo.room import DEMO_ROOM

__all__ = ["DEMO_ROOM"]
