"""All that is shown of a workbook: its part, its designs, and what elements look like."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from grasp_xl.grasp import Grasp, evaluate
from grasp_xl.task import Task
from grasp_xl.view.designs import Design
from grasp_xl.view.element_model import ElementModel
from grasp_xl.view.frame import Frame, FrameSizes, Standing, frame_over, frame_sizes, standing
from grasp_xl.view.part_shape import PartShape


@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """What is shown.

    Parameters
    ----------
    title : str
    task : Task
    part : PartShape
    models : tuple of ElementModel
        One a kind.
    designs : tuple of Design
    shown : Design
        The one that is shown first, and that models, drawing and bill are of.
    """

    title: str
    task: Task
    part: PartShape
    models: tuple[ElementModel, ...]
    designs: tuple[Design, ...]
    shown: Design

    @property
    def sizes(self) -> FrameSizes:
        """Sizes of the frame's bars."""
        return frame_sizes(self.models)

    def grasp(self, design: Design) -> Grasp:
        """Judge a design."""
        return evaluate(self.task.space, self.task.rules, design.chromosome)

    def grip(self, design: Design) -> Grip:
        """Return what stands on the part in a design, and the frame over it."""
        grasp = self.grasp(design)
        elements = standing(self.task.space, grasp)
        return Grip(grasp, elements, frame_over(grasp, elements, self.models, self.sizes))


@dataclass(frozen=True, slots=True)
class Grip:
    """A grasp, its elements and its frame."""

    grasp: Grasp
    elements: Sequence[Standing]
    frame: Frame
