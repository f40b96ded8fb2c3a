"""The glare-control classes of EN 14501:2005, by what a fabric lets through at normal incidence.

The limits are those under which the table of the standard is quoted; they were not read in the standard, and no data
sheet that prints class and transmittances together was at hand to check them. Users with a copy can: table "glare
control". The edition of 2021 classes by the cut-off angle, too, and is not covered.
"""

from bisect import bisect_left, bisect_right

NORMAL_NORMAL_LIMITS = (0.0, 0.05, 0.10)
"""Normal-normal transmittance, visible: rows of the table, each up to its limit; the last is past all."""

NORMAL_DIFFUSE_LIMITS = (0.02, 0.04, 0.08)
"""Normal-diffuse transmittance, visible: columns, each from its limit on; the first is below the first limit."""

CLASSES = ((4, 3, 2, 2), (3, 2, 1, 1), (1, 1, 0, 0), (0, 0, 0, 0))
"""Class by row and column: 0 very little effect, 4 very good effect."""

MEANINGS = ("very little effect", "little effect", "moderate effect", "good effect", "very good effect")

SMALLEST = 6
"""Decimals of a transmittance that count: 5 % less 3 % is 2 %, also in binary numbers."""

CAVEAT = (
    "limits as EN 14501:2005 is quoted, not read in the standard nor checked against data sheets: compare with your "
    "copy; the 2021 edition classes otherwise"
)


def glare_control_class(tau_nn: float, tau_n_dif: float) -> int:
    """Class of glare control, 0 to 4, of visible normal-normal and normal-diffuse transmittances [-]."""
    row = bisect_left(NORMAL_NORMAL_LIMITS, round(tau_nn, SMALLEST))
    column = bisect_right(NORMAL_DIFFUSE_LIMITS, round(tau_n_dif, SMALLEST))
    return CLASSES[row][column]
