"""A study described by a TOML file: parts, parameters with one value or several, and runs."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from grasp_xl.errors import InputError, OutputError, Problem, UsageError, refuse
from grasp_xl.fitment.material import MATERIALS
from grasp_xl.fitment.words import AXES, POLYGONS, UNITS
from grasp_xl.rules import TERMS, Criterion, moment_arm
from grasp_xl.study.plan import SCENARIOS, Scenario
from grasp_xl.workbook.layout import MAX_CHILDREN, MAX_GENERATIONS, MAX_SEED

T = TypeVar("T")

SUFFIX = ".toml"
MOST_RUNS = 100_000
MOST = 1e9
"""Largest number that a workbook's cell may hold, too."""
LEAST_ABOVE_0 = 1e-9

PITCH = "pitch"
"""The one parameter that is not of the runs but of the fitment."""


class Value(NamedTuple):
    """One value of a parameter, and how it is told."""

    value: Any
    told: str


class Parameter(NamedTuple):
    """What a parameter may be: its name in ``Parameters``, what is expected, and its parser.

    The parser returns None for what it does not take.
    """

    field: str
    expected: str
    parse: Callable[[Any], Any]


def _number(least: float, most: float = MOST) -> Callable[[Any], float | None]:
    def parse(value: Any) -> float | None:  # noqa: ANN401 (whatever a TOML file holds)
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        return float(value) if is_number and least <= value <= most else None

    return parse


def _whole(least: int, most: int) -> Callable[[Any], int | None]:
    def parse(value: Any) -> int | None:  # noqa: ANN401 (as above)
        number = _number(least, most)(value)
        return int(number) if number is not None and number == int(number) else None

    return parse


def _word(read: Callable[[str], T]) -> Callable[[Any], T | None]:
    def parse(value: Any) -> T | None:  # noqa: ANN401 (as above)
        try:
            return read(value) if isinstance(value, str) else None
        except UsageError:
            return None

    return parse


def _switch(value: Any) -> bool | None:  # noqa: ANN401 (as above)
    return value if isinstance(value, bool) else None


PARAMETERS: Mapping[str, Parameter] = {
    "generations": Parameter(
        "generations", f"a whole number from 0 to {MAX_GENERATIONS:,}", _whole(0, MAX_GENERATIONS)
    ),
    "one_in": Parameter("one_in", "a number of 1 or more", _number(1)),
    "children": Parameter(
        "children", f"a whole number from 2 to {MAX_CHILDREN}", _whole(2, MAX_CHILDREN)
    ),
    "elitism": Parameter("elitism", "true or false", _switch),
    "criterion": Parameter(
        "criterion",
        f"divergence, one of {', '.join(TERMS)}, or some of these joined by +",
        _word(Criterion.parse),
    ),
    "fos": Parameter("fos", "a number above 0", _number(LEAST_ABOVE_0)),
    "clearance": Parameter("clearance_mm", "a number above 0 (mm)", _number(LEAST_ABOVE_0)),
    "density_ratio": Parameter("density_ratio", "a number of 0 or more", _number(0)),
    "moment_arm": Parameter("moment_arm", "3d or plan", _word(moment_arm)),
    PITCH: Parameter(PITCH, "a number above 0 (mm)", _number(LEAST_ABOVE_0)),
}
"""What may have one value, or a list of several."""


def _text(value: Any) -> str | None:  # noqa: ANN401 (as above)
    return value if isinstance(value, str) and value else None


def _one_of(words: Collection[str]) -> Callable[[Any], str | None]:
    def parse(value: Any) -> str | None:  # noqa: ANN401 (as above)
        return value if isinstance(value, str) and value in words else None

    return parse


def _listed(words: Collection[str]) -> str:
    return f"one of {', '.join(words)}"


_PRICE = Parameter("", "a price of 0 or more ($)", _number(0))
_NAME = Parameter("", "a text", _text)
_ABOVE_0 = Parameter("", "a number above 0", _number(LEAST_ABOVE_0))
FIT_KEYS: Mapping[str, Parameter] = {
    "file": _NAME,
    "cup": _NAME,
    "magnet": _NAME,
    "cup_price": _PRICE,
    "magnet_price": _PRICE,
    "cup_faces": _NAME,
    "magnet_faces": _NAME,
    "material": Parameter("", _listed(MATERIALS), _one_of(MATERIALS)),
    "mass": _ABOVE_0,
    "polygon": Parameter("", _listed(POLYGONS), _one_of(POLYGONS)),
    "scale": _ABOVE_0,
    "up": Parameter("", _listed(AXES), _one_of(AXES)),
    "units": Parameter("", _listed(UNITS), _one_of(UNITS)),
    "thickness": _ABOVE_0,
}
"""What may stand in a table ``[[fit]]``: options of ``grasp-xl fit``."""


@dataclass(frozen=True, eq=False, slots=True)
class Description:
    """What a study is to run; None where nothing is said.

    Parameters
    ----------
    workbooks : tuple of Path
    fits : tuple of dict
        Parts that are fitted for the study: keys of ``FIT_KEYS``.
    varied : dict
        Name of a parameter to its values, in the order of the file.
    scenarios : tuple of {"random", "user"} or None
    runs, seed : int or None
    prove : bool or None
    prove_limit_s : float or None
    """

    workbooks: tuple[Path, ...] = ()
    fits: tuple[Mapping[str, Any], ...] = ()
    varied: Mapping[str, tuple[Value, ...]] | None = None
    scenarios: tuple[Scenario, ...] | None = None
    runs: int | None = None
    seed: int | None = None
    prove: bool | None = None
    prove_limit_s: float | None = None


def read_description(path: Path) -> Description:
    """Read a description; names in it are seen from its own folder.

    Raises
    ------
    InputError
        With everything that is wrong in it.
    """
    try:
        held = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise OutputError(
            f"{path} cannot be read ({error.strerror}).",
            where=str(path),
            hint="Name a file that describes a study",
        ) from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        hint = "see docs/study.md for an example"
        problem = Problem(str(path), f"what is no TOML ({error})", "a description of a study", hint)
        raise InputError([problem]) from error
    return _Reader(path).read(held)


class _Reader:
    """Reads a description, and remembers what is wrong in it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._problems: list[Problem] = []

    def read(self, held: Mapping[str, Any]) -> Description:
        known = {"workbooks", "fit", "scenarios", "runs", "seed", "prove", "prove_limit"}
        for name in held.keys() - known - PARAMETERS.keys():
            expected = ", ".join(sorted(known | PARAMETERS.keys()))
            self._refuse(name, "a name that means nothing here", f"one of {expected}")
        described = Description(
            self._workbooks(held.get("workbooks", [])),
            self._fits(held.get("fit", [])),
            {name: self._values(name, held[name]) for name in held if name in PARAMETERS},
            self._scenarios(held.get("scenarios")),
            self._one(
                held, "runs", f"a whole number from 1 to {MOST_RUNS:,}", _whole(1, MOST_RUNS)
            ),
            self._one(held, "seed", f"a whole number from 0 to {MAX_SEED}", _whole(0, MAX_SEED)),
            self._one(held, "prove", "true or false", _switch),
            self._one(held, "prove_limit", "a number of 0 or more (s)", _number(0)),
        )
        refuse(self._problems, str(self._path))
        return described

    def _refuse(self, name: str, found: str, expected: str) -> None:
        self._problems.append(Problem(f"{self._path}: {name}", found, expected))

    def _one(
        self, held: Mapping[str, Any], name: str, expected: str, parse: Callable[[Any], T | None]
    ) -> T | None:
        if name not in held:
            return None
        value = parse(held[name])
        if value is None:
            self._refuse(name, repr(held[name]), expected)
        return value

    def _workbooks(self, held: Any) -> tuple[Path, ...]:  # noqa: ANN401 (whatever TOML holds)
        if isinstance(held, list) and all(isinstance(name, str) for name in held):
            return tuple(self._path.parent / name for name in held)
        self._refuse("workbooks", repr(held), "a list of names of files")
        return ()

    def _scenarios(self, held: Any) -> tuple[Scenario, ...] | None:  # noqa: ANN401 (as above)
        if held is None:
            return None
        if isinstance(held, list) and held and all(each in SCENARIOS for each in held):
            return tuple(each for each in SCENARIOS if each in held)
        self._refuse("scenarios", repr(held), 'a list of "random" and "user"')
        return None

    def _values(self, name: str, held: Any) -> tuple[Value, ...]:  # noqa: ANN401 (as above)
        parameter = PARAMETERS[name]
        values = []
        for each in held if isinstance(held, list) else [held]:
            value = parameter.parse(each)
            if value is None:
                self._refuse(name, repr(each), parameter.expected)
            else:
                values.append(Value(value, f"{each}"))
        if isinstance(held, list) and not held:
            self._refuse(name, "an empty list", parameter.expected)
        if len({told for _, told in values}) < len(values):
            self._refuse(name, repr(held), "different values")
        return tuple(values)

    def _fits(self, held: Any) -> tuple[Mapping[str, Any], ...]:  # noqa: ANN401 (as above)
        if not isinstance(held, list) or not all(isinstance(each, dict) for each in held):
            self._refuse("fit", repr(held), "tables [[fit]]")
            return ()
        return tuple(self._fit(number, each) for number, each in enumerate(held, 1))

    def _fit(self, number: int, held: Mapping[str, Any]) -> Mapping[str, Any]:
        read: dict[str, Any] = {}
        for key, told in held.items():
            parameter = FIT_KEYS.get(key)
            value = parameter.parse(told) if parameter else None
            if parameter is None:
                self._refuse(f"fit {number}", repr(key), _listed(FIT_KEYS))
            elif value is None:
                self._refuse(f"fit {number}, {key}", repr(told), parameter.expected)
            read[key] = value
        if "file" not in held:
            self._refuse(f"fit {number}", "no file", "a STEP or DXF file")
        elif read["file"]:
            read["file"] = self._path.parent / read["file"]
        return read
