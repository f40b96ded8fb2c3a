"""Studies: what Sunpeak makes of products whose right answer is known."""

from sunpeak.studies.figure2 import write_figure2
from sunpeak.studies.peaks import Plan, run_peaks
from sunpeak.studies.peaks_report import markdown

__all__ = ["Plan", "markdown", "run_peaks", "write_figure2"]
