"""The long table of a study, for pandas."""

from __future__ import annotations

import dataclasses

import numpy as np
import pandas as pd
import pytest
from pandas.testing import assert_frame_equal
from test_study import BRACKET, DOOR_FRAME, all_runs, plan_of

from grasp_xl.cli.program import main
from grasp_xl.errors import UsageError
from grasp_xl.search.result import measured_rows
from grasp_xl.study import data_file
from grasp_xl.study.data_file import check_format, write_data
from grasp_xl.study.plan import Plan
from grasp_xl.study.trial import Record


@pytest.fixture(scope="module")
def plan() -> Plan:
    found = plan_of(BRACKET, DOOR_FRAME)
    varied = [dataclasses.replace(case, varied=(("one_in", "4"),)) for case in found.cases]
    return dataclasses.replace(found, cases=tuple(varied))


@pytest.fixture(scope="module")
def records(plan: Plan) -> dict[str, Record]:
    return all_runs(plan)


def written(path, plan, records):
    write_data(path, plan, ((trial, records[trial.label]) for trial in plan.trials()))
    return path


def read_csv(path):
    """Read a table with Python's own floats, which are exact."""
    return pd.read_csv(path, engine="python")


def test_csv_has_every_change_of_every_run(tmp_path, plan, records, monkeypatch):
    """Read back, each run's rows are what the criteria say of its changes, and its last row."""
    monkeypatch.setattr(data_file, "RUNS_AT_ONCE", 3)
    table = read_csv(written(tmp_path / "runs.csv", plan, records))
    assert list(dict.fromkeys(table["label"])) == [trial.label for trial in plan.trials()]
    assert set(table["one_in"]) == {4}
    for trial in plan.trials():
        mine = table[table["label"] == trial.label]
        task, record = plan.cases[trial.case].task, records[trial.label]
        rows = pd.DataFrame(measured_rows(task.space, task.rules, record.changes))
        assert set(mine["seed"]) == {trial.seed}
        assert mine["generation"].iloc[-1] == record.done
        held = mine.head(len(rows))
        for name in rows:
            assert np.array_equal(
                held[name].to_numpy(dtype=float),
                rows[name].to_numpy(dtype=float),
                equal_nan=True,
            ), name


def test_parquet_is_the_same_table(tmp_path, plan, records, monkeypatch):
    """Both formats have the same columns, rows and numbers."""
    monkeypatch.setattr(data_file, "RUNS_AT_ONCE", 3)
    text = read_csv(written(tmp_path / "runs.csv", plan, records))
    held = pd.read_parquet(written(tmp_path / "runs.parquet", plan, records))
    assert list(held.columns) == list(text.columns)
    numbers = {"one_in": "int64"}
    assert_frame_equal(held.astype(numbers), text, check_dtype=False)


def test_a_missing_package_is_told_before_any_work(tmp_path, monkeypatch):
    """Without pyarrow a .parquet file is refused in a sentence, and .csv is not."""
    monkeypatch.setattr(data_file, "find_spec", {}.get)
    check_format(tmp_path / "runs.csv")
    with pytest.raises(UsageError, match="pyarrow"):
        check_format(tmp_path / "runs.parquet")


@pytest.mark.parametrize(
    ("option", "name"), [("--data", "runs.xls"), ("--html", "page.txt"), ("--data", "no/runs.csv")]
)
def test_places_that_cannot_be_written_are_refused_first(tmp_path, capsys, option, name):
    """A wrong ending or a missing folder is told before anything is run, and nothing is left."""
    words = ["study", str(BRACKET), "-o", str(tmp_path / "s.xlsx"), option, str(tmp_path / name)]
    assert main(words) in (2, 3)
    assert "nothing was written" in (told := capsys.readouterr().err) or name in told
    assert not list(tmp_path.iterdir())


def test_a_page_of_others_is_not_replaced(tmp_path):
    """--html replaces its own pages, and no other without --force."""
    page = tmp_path / "page.html"
    page.write_text("<p>theirs</p>")
    words = ["study", str(BRACKET), "-o", str(tmp_path / "s.xlsx"), "--generations", "20"]
    words += ["--no-prove", "--quiet", "--html", str(page)]
    assert main(words) == 3
    assert page.read_text() == "<p>theirs</p>"
    assert main([*words, "--force"]) == 0
    assert main([*words, "--resume"]) == 0
    assert "P1S1R1" in page.read_text()
