"""`sunpeak demo`: a room behind a fabric, without and with peak extraction, from four tables of the fabric."""

from sunpeak.demo.expectation import Expectation, expectation
from sunpeak.demo.results import Case, Pair, pairs
from sunpeak.demo.study import Plan, cases

__all__ = ["Case", "Expectation", "Pair", "Plan", "cases", "expectation", "pairs"]
