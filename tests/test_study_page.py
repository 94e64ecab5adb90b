"""The page of a study: the same as its workbook, in one file."""

from __future__ import annotations

import dataclasses
import math
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from test_study import BRACKET, DOOR_FRAME, all_runs, plan_of

from grasp_xl.study.outcome import Measuring
from grasp_xl.study.page import _median, study_page
from grasp_xl.study.plan import Plan
from grasp_xl.study.plot import WIDTH, Curve, plot, ticks
from grasp_xl.study.summary import Study, answers, rows


def study_of(plan: Plan) -> Study:
    records = all_runs(plan)
    cases = []
    for number, case in enumerate(plan.cases):
        mine = [(t, records[t.label]) for t in plan.trials() if t.case == number]
        cases.append(Measuring(plan, case).case_outcome(mine, None))
    return Study(plan, tuple(cases))


class Reader(HTMLParser):
    """Notes the texts of a page, and whether every element that is opened is closed in order."""

    ALONE = ("meta", "link", "line", "path", "br")

    def __init__(self, page: str) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.open: list[str] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag, attrs):
        """Note an element."""
        self.attributes += attrs
        if tag not in self.ALONE:
            self.open.append(tag)

    def handle_startendtag(self, _tag, attrs):
        """Note an element without contents."""
        self.attributes += attrs

    def handle_endtag(self, tag):
        """Close the last element that is open."""
        assert self.open.pop() == tag

    def handle_data(self, data):
        """Note a text."""
        self.texts.append(data)


@pytest.mark.parametrize("runs", [1, 2, 60])
def test_a_page_has_every_number_of_the_summary(runs):
    """Summary, answers and all labels of few runs stand on it; it is whole and asks nobody."""
    study = study_of(plan_of(BRACKET, DOOR_FRAME, runs=runs, generations=100))
    page = study_page(study)
    read = Reader(page)
    assert not read.open
    text = " ".join(read.texts)
    for row in rows(study):
        for value in row:
            if isinstance(value, float):
                assert any(shown in text for shown in (f"{value:,.4f}", f"{value:,.0f}"))
            else:
                assert str("-" if value is None else value) in text
    for answer in answers(study):
        assert all(line in text for line in answer.answer.splitlines())
    if runs <= 2:
        assert all(trial.label in text for trial in study.plan.trials())
    assert page.count("<svg viewBox") >= 12
    places = [value for name, value in read.attributes if name in ("src", "href", "style")]
    assert places == ["data:,"]
    assert not re.search(r"https?:|@import|url\(|<script", page)


def test_the_same_study_gives_the_same_page():
    """There are no times on it: seconds that differ change nothing."""
    study = study_of(plan_of(BRACKET, generations=100))
    case = study.cases[0]
    slower = tuple(dataclasses.replace(each, seconds=9.0) for each in case.outcomes)
    other = dataclasses.replace(study, cases=(dataclasses.replace(case, outcomes=slower),))
    assert study_page(study) == study_page(other)


def test_a_hostile_name_stays_text():
    """A part's name with markup in it is shown as it is, and is no element."""
    plan = plan_of(BRACKET, generations=50)
    name = '<script>alert("x")</script>&<img src=x onerror=y>'
    plan = dataclasses.replace(plan, cases=(dataclasses.replace(plan.cases[0], name=name),))
    page = study_page(study_of(plan))
    read = Reader(page)
    assert "<script" not in page
    assert "<img" not in page
    assert any(name in text for text in read.texts)


def test_a_median_course_is_the_middle_of_its_runs():
    """Of an even number of runs it is halfway, as in the summary; few values make none."""
    study = study_of(plan_of(BRACKET, generations=50))
    first = study.cases[0].outcomes[0]
    values = ([1.0, 1.0], [3.0, math.nan], [math.nan, math.nan], [2.0, math.nan])
    runs = [dataclasses.replace(first, course=np.array([each])) for each in values]
    assert np.array_equal(_median(runs), [[2.5, math.nan]], equal_nan=True)


@given(st.floats(-1e6, 1e6), st.floats(1e-6, 1e6))
def test_ticks_are_few_round_and_within(low, size):
    """An axis names two to eleven values inside its range, all one step apart."""
    found = ticks(low, low + size)
    assert 1 <= len(found) <= 11
    slack = 1e-9 * max(1.0, abs(low), size)
    assert all(low - slack <= tick <= low + size + slack for tick in found)
    if len(found) > 2 and abs(low) < 1e3 * size:
        assert np.ptp(np.diff(found)) <= 1e-6 * size


def test_a_plot_draws_steps_and_leaves_gaps():
    """A course stays level until the next value; where there is none, its line ends."""
    generations = np.array([1, 10, 100, 1000])
    values = np.array([1.0, 2.0, math.nan, 3.0])
    picture = plot("FoS", "FoS", [Curve("s0", generations, values)])
    (path,) = re.findall(r'<path class="course s0" d="([^"]*)"', picture)
    moves = re.findall(r"([ML])([\d.]+) ([\d.]+)", path)
    assert [letter for letter, _, _ in moves] == ["M", "L", "L", "M"]
    (_, _, y0), (_, x1, y1), (_, x2, y2), _ = moves
    assert y0 == y1
    assert x1 == x2
    assert float(y2) < float(y1)


def test_labels_of_whole_decades_stand_inside_the_picture():
    """The last decade's number is centred on the edge of the field, with room for its half."""
    for last in (10, 1_000, 1_000_000):
        generations = np.array([1, last])
        picture = plot("FoS", "FoS", [Curve("s0", generations, np.array([1.0, 2.0]))])
        place, number = re.findall(
            r'x="([\d.]+)" y="[\d.]+" text-anchor="middle">([\d,]+)<', picture
        )[-1]
        assert number == f"{last:,}"
        assert float(place) + 0.6 * 11 * len(number) / 2 <= WIDTH + 2
