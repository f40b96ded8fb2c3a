"""Studies: what Sunpeak makes of products whose right answer is known, and of the paper's experiments."""

from sunpeak.studies.figure2 import write_figure2
from sunpeak.studies.figures import FiguresPlan
from sunpeak.studies.figures_report import write_figures
from sunpeak.studies.peaks import Plan, run_peaks
from sunpeak.studies.peaks_report import markdown
from sunpeak.studies.table1 import Table1Plan, run_table1
from sunpeak.studies.table1_report import table1_targets, write_table1

__all__ = [
    "FiguresPlan",
    "Plan",
    "Table1Plan",
    "markdown",
    "run_peaks",
    "run_table1",
    "table1_targets",
    "write_figure2",
    "write_figures",
    "write_table1",
]
