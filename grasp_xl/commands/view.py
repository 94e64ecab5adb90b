"""What ``view`` shows of a workbook, and the files that it writes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from grasp_xl.bill import Line, bill_of
from grasp_xl.commands.preparing import Active, given_grasp, prepare_to_judge
from grasp_xl.errors import Problem, UsageError
from grasp_xl.fitment.catalogue import read_catalogue
from grasp_xl.fitment.step_file import not_installed
from grasp_xl.task import Parameters, Task
from grasp_xl.view.assembly import MARK
from grasp_xl.view.bill_file import HEADER, bill_csv
from grasp_xl.view.designs import Design, chosen, designs_of
from grasp_xl.view.element_model import ElementModel, element_model
from grasp_xl.view.part_shape import part_shape
from grasp_xl.view.pasted import pasted_grasp
from grasp_xl.view.scene import Scene
from grasp_xl.workbook.book import Book, read_book
from grasp_xl.workbook.grasp_sheet import Rendering
from grasp_xl.workbook.layout import DEFAULT_DIAMETERS_MM
from grasp_xl.workbook.part_sheet import CUP_ANGLE, MAGNET_ANGLE
from grasp_xl.workbook.reading_run import SavedRun, logged_values
from grasp_xl.workbook.saving import check_place, refuse_theirs, save

PAGE, STEP, GLTF, DRAWING, BILL = (".html",), (".step", ".stp"), (".glb",), (".dxf",), (".csv",)
SUFFIXES = (*PAGE, *STEP, *GLTF, *DRAWING, *BILL)


@dataclass(frozen=True, slots=True)
class Wish:
    """What a person asked to see.

    Parameters
    ----------
    path : Path
        Workbook.
    design : str or None
        Key of the design that is shown.
    grasp : Active
        A grasp given by indices.
    genes : str or None
        A grasp given as two rows of genes.
    part, catalogue : Path or None
        STEP file of the part; the designer's own elements.
    """

    path: Path
    design: str | None
    grasp: Active
    genes: str | None
    part: Path | None
    catalogue: Path | None


@dataclass(frozen=True, slots=True)
class Viewed:
    """What was shown, and what is odd about it."""

    scene: Scene
    warnings: tuple[Problem, ...]

    @property
    def bill(self) -> list[Line]:
        """Bill of material of the shown design."""
        return bill_of(self.scene.task.space, self.scene.grasp(self.scene.shown))


def view_file(wish: Wish, output: Path, *, force: bool) -> Viewed:
    """Show the designs of a workbook in a file.

    Raises
    ------
    UsageError, InputError
        If something that was asked for is not there.
    GraspError
        If a package that the file needs is not installed.
    OutputError
        If it cannot be written.
    """
    check_place(output, SUFFIXES, force=force)
    refuse_theirs(output, [MARK, ",".join(HEADER)], "view", force=force)
    write = _writer(output.suffix.lower())
    viewed = scene_of(wish)
    _refuse_the_part(output, viewed.scene.part.file)
    if output.suffix.lower() in BILL:  # it says nothing of the part
        told = [each for each in viewed.warnings if each not in viewed.scene.part.notes]
        viewed = replace(viewed, warnings=tuple(told))
    save(write(viewed.scene), output)
    return viewed


def _refuse_the_part(output: Path, part: Path | None) -> None:
    """Refuse to replace the part's own file, whatever is forced."""
    if part and output.exists() and output.samefile(part):
        raise UsageError(
            f"The output {output} is the part's own file.",
            where=str(output),
            hint="Name another file with -o",
        )


def _writer(suffix: str) -> Callable[[Scene], bytes]:
    """Return what writes a kind of file.

    Raises
    ------
    GraspError
        If a package that it needs is not installed.
    """
    if suffix in PAGE:
        from grasp_xl.view.page import page_of

        return page_of
    if suffix in GLTF:
        from grasp_xl.view.gltf_file import gltf_of

        return gltf_of
    if suffix in DRAWING:
        from grasp_xl.view.drawing import drawing_of

        return drawing_of
    if suffix in BILL:
        return bill_csv
    try:
        from grasp_xl.view.step_assembly import step_of
    except ImportError as error:
        raise not_installed(error, "write the design as .glb or .dxf") from error
    return step_of


def scene_of(wish: Wish) -> Viewed:
    """Return what a person asked to see.

    Raises
    ------
    UsageError, InputError, GraspError
        If something that was asked for is not there, or cannot be read.
    """
    book = read_book(wish.path)
    given = given_grasp(book.space, wish.grasp)
    if wish.genes is not None:
        if given:
            raise UsageError(
                "Both --genes and --cups or --magnets were given.",
                where="--genes",
                hint="Give the grasp in one way",
            )
        given = pasted_grasp(wish.genes, book.space, "--genes")
    if given and wish.design is not None:
        raise UsageError(
            "Both --design and a grasp were given.",
            where="--design",
            hint="Name a design of the workbook, or give a grasp",
        )
    task = prepare_to_judge(book, Parameters(), given)
    shape = part_shape(book.space, book.part, wish.path, wish.part)
    models = _models(book, wish.catalogue)
    run = book.shown_run()
    designs = designs_of(book, run, task, given)
    scene = Scene(wish.path.name, task, shape, models, designs, chosen(designs, wish.design))
    return Viewed(scene, (*task.warnings, *_edited_run(book, run), *shape.notes))


def _edited_run(book: Book, run: SavedRun | None) -> list[Problem]:
    """Return a warning where the workbook holds a run that cannot be read any more."""
    if run or not logged_values(book.source):
        return []
    found, expected = "a run whose lists were edited", "the rows as they were written"
    return [Problem(book.source.name, found, expected, "its designs are not shown; run it again")]


def rendered(book: Book, task: Task, design: Design) -> tuple[Rendering, tuple[Problem, ...]]:
    """Return a picture of a design for its workbook, and what is odd about the part in it."""
    from grasp_xl.view.picture import picture_of

    path = Path(book.source.name)
    shape = part_shape(task.space, book.part, path, None)
    scene = Scene(path.name, task, shape, _models(book, None), (design,), design)
    cups, magnets = (", ".join(map(str, active)) for active in design.chromosome.active)
    told = f"PICTURE of this run: {design.name} (cups {cups or '-'}; magnets {magnets or '-'})"
    return Rendering(picture_of(scene), told), shape.notes


def _models(book: Book, catalogue: Path | None) -> tuple[ElementModel, ...]:
    """Return what the elements look like."""
    elements = {each.model: each for each in read_catalogue(catalogue).elements}
    models = []
    for kind, angle, default in zip(
        book.space.kinds, (CUP_ANGLE, MAGNET_ANGLE), DEFAULT_DIAMETERS_MM, strict=True
    ):
        turned = book.part.fact(angle) if book.part else None
        degrees = float(turned) if isinstance(turned, int | float) else 0.0
        models.append(element_model(kind, elements.get(kind.model), default, degrees))
    return tuple(models)
