"""Title of a sheet of results: says by itself when they are no longer those of the inputs."""

from grasp_xl.workbook.calc_inputs import INPUTS_EDITED
from grasp_xl.workbook.pen import Pen
from grasp_xl.workbook.styles import Style

OUTDATED = " (of the inputs before they were edited; run again)"


def write_result_title(pen: Pen, title: str) -> None:
    """Write the title of a sheet whose numbers are not worked out by formulas."""
    formula = f'"{title}"&IF({INPUTS_EDITED}>0,"{OUTDATED}","")'
    pen.write(0, 0, title, Style.TITLE, formula)
