"""What an input may be: in words, and as a formula.

The reader demands the same; here it is said again as formulas, since a designer types without it.
What else it refuses (a place twice, a polygon that touches itself, dates) only reading finds.
"""

from __future__ import annotations

from dataclasses import dataclass

from grasp_xl.rules import DIVERGENCE, TERMS
from grasp_xl.space import MAX_COUNT, OptionSpace
from grasp_xl.workbook import layout
from grasp_xl.workbook.cells import MAX_NUMBER
from grasp_xl.workbook.layout import KINDS, Area

SLACK = "1E-9"
"""Relative slack of a comparison, and the least number that counts as above 0."""
LIMIT = f"{MAX_NUMBER:.0f}"
MAX_CHECKED_CORNERS = 100
"""Corners of a polygon whose crossings formulas look for: their work grows with the square."""


@dataclass(frozen=True, slots=True)
class Rule:
    """What an input may be.

    Parameters
    ----------
    words : str
        Behind "type".
    formula : str
        Formula on ``{x}``, the input, that gives 1 or 0, and never an error.
    words_formula : str
        Formula of the words, where they depend on other cells.
    """

    words: str
    formula: str
    words_formula: str = ""


def blank(cell: str) -> str:
    """Return a test that is true where a cell holds nothing."""
    return f'TRIM({cell}&"")=""'


def _number(words: str, test: str) -> Rule:
    return Rule(words, f"IF(ISNUMBER({{x}}),IF(AND({test},ABS({{x}})<={LIMIT}),1,0),0)")


def _or_blank(rule: Rule) -> Rule:
    formula = f"IF(ISERROR({{x}}),0,IF({blank('{x}')},1,{rule.formula}))"
    return Rule(f"{rule.words}, or nothing", formula)


def _whole(least: int, most: int) -> Rule:
    return Rule(
        f"a whole number from {least} to {most:,}",
        f"IF(ISNUMBER({{x}}),IF(AND({{x}}>={least},{{x}}<={most},{{x}}=INT({{x}})),1,0),0)",
    )


def _criterion_test() -> str:
    """Test for a text that is nothing but known terms behind a +, in any order."""
    words = 'SUBSTITUTE(SUBSTITUTE("+"&TRIM(LOWER({x}))," +","+"),"+ ","+")'
    for term in TERMS:
        words = f'SUBSTITUTE({words},"+{term}"," ")'
    return f'TRIM({words})=""'


AT_MOST = f"at most {MAX_NUMBER:,.0f}"
ANY = _number(f"a number, {AT_MOST} in size", "TRUE")
ABOVE_0 = _number(f"a number above 0, {AT_MOST}", f"{{x}}>={SLACK}")
FROM_0 = _number(f"a number of 0 or more, {AT_MOST}", "{x}>=0")
FRACTION = _number("a number above 0, at most 1", f"AND({{x}}>={SLACK},{{x}}<=1)")
COUNT = _whole(0, MAX_COUNT)
SWITCH = Rule("1 or 0", "IF(ISLOGICAL({x}),1,IF(ISNUMBER({x}),IF(OR({x}=0,{x}=1),1,0),0))")
ARM = Rule("3d or plan", 'IF(OR(TRIM({x})="3d",TRIM({x})="plan"),1,0)')
CRITERION = Rule(
    f"{DIVERGENCE}, one criterion, or some joined by +",
    f'IF(OR(LOWER(TRIM({{x}}))="{DIVERGENCE}",{_criterion_test()}),1,0)',
)
KIND_RULES = {
    "Max": COUNT,
    "Force": ABOVE_0,
    "Price": FROM_0,
    "Weight": _or_blank(FROM_0),
}
PARAMETER_RULES = {
    "UserStart": _or_blank(SWITCH),
    "Elitism": _or_blank(SWITCH),
    "MutationOneIn": _or_blank(_number(f"a number of 1 or more, {AT_MOST}", "{x}>=1")),
    "Generations": _or_blank(_whole(0, layout.MAX_GENERATIONS)),
    "MinClearance": _or_blank(ABOVE_0),
    "DensityRatio": _or_blank(FROM_0),
    "FitnessCriterion": _or_blank(CRITERION),
    "FoSGoal": _or_blank(ABOVE_0),
    "Children": _or_blank(_whole(2, layout.MAX_CHILDREN)),
    "Seed": _or_blank(_whole(0, layout.MAX_SEED)),
    "MomentArm": _or_blank(ARM),
}
DIAMETER = _or_blank(ABOVE_0)


def goal(own: str) -> Rule:
    """Return the rule of a goal; ``own``, the user-defined grasp's value, may be any number."""
    typed = f"AND({{x}}>={SLACK},{{x}}<={LIMIT})"
    return Rule(ABOVE_0.words, f"IF(ISNUMBER({{x}}),IF(OR({typed},{{x}}={own}),1,0),0)")


def listed(space: OptionSpace, number: int) -> str:
    """Return a formula of how many places of a kind the workbook's formulas know."""
    return f"ROWS({KINDS[number].locations_name})" if space.kinds[number].total else "0"


def least_count(space: OptionSpace, number: int) -> Rule:
    """Return the rule of a kind's Min."""
    most = f"MIN({KINDS[number].field('Max')},{listed(space, number)})"
    fits = f"IF(ISNUMBER({KINDS[number].field('Max')}),{{x}}<={most},TRUE)"
    words = "a whole number from 0 to Max. and to the number of places"
    test = f"AND({{x}}>=0,{{x}}=INT({{x}}),{fits})"
    return Rule(words, f"IF(ISNUMBER({{x}}),IF({test},1,0),0)")


def total(space: OptionSpace, number: int) -> Rule:
    """Return the rule of a kind's total: what formulas refer to does not grow with a list."""
    rows, count = listed(space, number), space.kinds[number].total
    words = ", the places that the cards know; for a longer list run grasp-xl on this workbook"
    formula = f"IF(ISNUMBER({{x}}),IF({{x}}={rows},1,0),0)"
    return Rule(f"{count}{words}", formula, f'{rows}&"{words}"')


def places(name: str) -> Rule:
    """Return the rule of a list of places."""
    first = f"SUMPRODUCT(MIN(ROW({name})-MIN(ROW({name}))+1+{LIMIT}*ISNUMBER({name})))"
    words, filled = "three numbers at every index", "COUNT({x})=3*ROWS({x})"
    told = f'IF({filled.format(x=name)},"{words}","three numbers at index "&{first})'
    return Rule(words, f"IF({filled},1,0)", told)


def polygon(corners: int) -> Rule:
    """Return the rule of the ideal polygon; a corner typed below the last is none of a card's."""
    words = "numbers, around an area, and no corner twice in a row"
    area = "EdgeStartX*EdgeY-EdgeStartY*EdgeX"
    sound = "1"
    if corners <= MAX_CHECKED_CORNERS:
        words = "numbers, around an area, no corner twice in a row, no edge across another"
        sound = "IF(SUM(EdgeCrossings)=0,1,0)"
    row, column = layout.POLYGON_HEADER_ROW + 1 + corners, layout.APPROXIMATION_COLUMN + 1
    added = f"COUNTA({Area(layout.OPTION_SPACE, row, column, 1, 3).reference})"
    test = f"AND(MIN(EdgeSquared)>0,ABS(SUMPRODUCT({area}))>1E-12*SUM(EdgeSquared),{added}=0)"
    known = "the corners that the cards know; for more run grasp-xl on this workbook"
    formula = f"IF(COUNT({{x}})=3*ROWS({{x}}),IF({test},{sound},0),0)"
    return Rule(words, formula, f'IF({added}=0,"{words}","{known}")')
