"""What the exact search says of a task, in the workbook's words."""

from __future__ import annotations

from dataclasses import dataclass

from grasp_xl.grasp import Grasp
from grasp_xl.rounding import percent
from grasp_xl.rules import TERMS, Criterion
from grasp_xl.search.exact import ExactSettings, Proof
from grasp_xl.workbook import layout
from grasp_xl.workbook.table import CRITERIA

BEST_KNOWN = "Best known"
NOT_PROVED = "Not proved"
PROVED_BOUND = "Proved bound"
LEGENDS = (layout.PROVED.label, BEST_KNOWN, NOT_PROVED, PROVED_BOUND)
"""What the lines of the exact search are called in the charts."""
ALL_GRASPS = "all grasps"
NO_PROOF = (
    "No proof was made. grasp-xl run makes one unless --no-prove is given;",
    "grasp-xl solve with -o makes one without a run.",
)


@dataclass(frozen=True, eq=False, slots=True)
class Proved:
    """A proof, and what it is about.

    Parameters
    ----------
    proof : Proof
    among : str
        Which grasps were looked at.
    ended : str
        Why the search ended.
    """

    proof: Proof
    among: str = ALL_GRASPS
    ended: str = ""

    @property
    def grasp(self) -> Grasp | None:
        """The best grasp; None where none was found."""
        return self.proof.designs[0] if self.proof.designs else None

    @property
    def label(self) -> str:
        """What that grasp is, in two words."""
        return layout.PROVED.label if self.proof.status == "optimal" else BEST_KNOWN

    @property
    def title(self) -> str:
        """What that grasp is, and how far from proved: the title of its card."""
        whose = "" if self.among == ALL_GRASPS else f" among {self.among}"
        if self.proof.status == "optimal":
            return f"{self.label}{whose}"
        if self.proof.gap is None:
            return f"{NOT_PROVED}{whose} (no grasp found)"
        return f"{self.label}{whose} (not proved; gap {percent(self.proof.gap)})"


def among(settings: ExactSettings) -> str:
    """Name the grasps that a search looks at.

    Examples
    --------
    >>> among(ExactSettings()), among(ExactSettings(meet_goals=True, min_elements=3))
    ('all grasps', 'those that meet all goals and have 3 or more elements')
    """
    demands = ["meet all goals"] if settings.meet_goals else []
    if settings.min_elements > 1:
        demands.append(f"have {settings.min_elements} or more elements")
    return f"those that {' and '.join(demands)}" if demands else ALL_GRASPS


def charted(criterion: Criterion) -> int | None:
    """Return which of ``CRITERIA`` is minimised; None where that is a sum of some.

    Examples
    --------
    >>> [charted(Criterion.parse(text)) for text in ("divergence", "cost", "cost+moment")]
    [5, 1, None]
    """
    if len(criterion.terms) == len(TERMS):
        return len(CRITERIA) - 1
    return 1 + TERMS.index(criterion.single) if criterion.single else None
