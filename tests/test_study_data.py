"""The long table of a study, for pandas."""

from __future__ import annotations

import dataclasses
import errno
import os
import sys

import numpy as np
import pandas as pd
import pytest
from pandas.testing import assert_frame_equal
from test_study import BRACKET, DOOR_FRAME, all_runs, plan_of

from grasp_xl.chromosome import BLANK_GENE
from grasp_xl.cli.program import main
from grasp_xl.errors import OutputError, UsageError
from grasp_xl.search.result import measured_rows
from grasp_xl.study import data_file
from grasp_xl.study.data_file import check_format, write_data
from grasp_xl.study.description import PARAMETERS
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


@pytest.mark.parametrize("name", PARAMETERS)
def test_a_varied_parameter_hides_no_criterion(tmp_path, plan, records, name):
    """Whatever a study varies, its values and the criteria have columns of their own."""
    cases = [dataclasses.replace(case, varied=((name, "2.5"),)) for case in plan.cases]
    named = dataclasses.replace(plan, cases=tuple(cases))
    trial = next(plan.trials())
    write_data(tmp_path / "runs.csv", named, [(trial, records[trial.label])])
    table = read_csv(tmp_path / "runs.csv")
    task = plan.cases[0].task
    rows = pd.DataFrame(measured_rows(task.space, task.rules, records[trial.label].changes))
    held = table.head(len(rows))
    assert set(table[data_file.RENAMED.get(name, name)].astype(str)) == {"2.5"}
    for column in rows:
        assert np.array_equal(
            held[column].to_numpy(dtype=float), rows[column].to_numpy(dtype=float), equal_nan=True
        ), column


def test_a_part_with_fewer_slots_has_no_genes_where_others_have(tmp_path, plan, records):
    """The table is as wide as the widest part; a narrower one leaves its last genes empty."""
    case = plan.cases[1]
    kinds = tuple(dataclasses.replace(kind, count_max=7) for kind in case.task.space.kinds)
    space = dataclasses.replace(case.task.space, kinds=kinds)
    wide = dataclasses.replace(case, task=dataclasses.replace(case.task, space=space))
    mixed = dataclasses.replace(plan, cases=(plan.cases[0], wide))
    runs = []
    for trial in plan.trials():
        record = records[trial.label]
        if trial.case:
            longer = [(0, 0), (0, 0), (0, 2)]
            genes = np.pad(record.genes, longer, constant_values=BLANK_GENE)
            record = dataclasses.replace(record, genes=genes)
        runs.append((trial, record))
    for name, read in (("runs.csv", read_csv), ("runs.parquet", pd.read_parquet)):
        write_data(tmp_path / name, mixed, runs)
        table = read(tmp_path / name)
        is_narrow = table["case"] == "P1"
        for gene in ("S6", "S7", "M6", "M7"):
            assert np.array_equal(table[gene].isna(), is_narrow)
        assert table[["S5", "M5"]].notna().all(axis=None)


@pytest.mark.parametrize("suffix", data_file.SUFFIXES)
def test_a_study_without_runs_is_a_table_without_rows(tmp_path, plan, records, suffix):
    """Stopped before its first run, a study has a file that can be read, with all columns."""
    read = pd.read_csv if suffix == ".csv" else pd.read_parquet
    write_data(tmp_path / f"none{suffix}", plan, [])
    none = read(tmp_path / f"none{suffix}")
    assert len(none) == 0
    some = read(written(tmp_path / f"some{suffix}", plan, records))
    assert list(none.columns) == list(some.columns)


@pytest.mark.skipif(sys.platform == "win32", reason="links and rights of POSIX")
def test_a_link_stays_a_link_and_a_private_file_private(tmp_path, plan):
    """A table replaces the file that a link names, and keeps who may read it."""
    target, link = tmp_path / "real.csv", tmp_path / "link.csv"
    target.touch(0o600)
    link.symlink_to(target)
    write_data(link, plan, [])
    assert link.is_symlink()
    assert target.stat().st_size > 0
    assert target.stat().st_mode & 0o777 == 0o600


def test_a_failure_halfway_leaves_the_old_table_and_nothing_beside_it(tmp_path, plan, records):
    """Where the runs cannot be read to their end, what stood there stays."""
    target = tmp_path / "runs.csv"
    target.write_text("old")
    trial = next(plan.trials())

    def runs():
        yield trial, records[trial.label]
        raise OSError(errno.ENOSPC, "full")

    with pytest.raises(OutputError, match="disk is full"):
        write_data(target, plan, runs())
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


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


@pytest.mark.skipif(sys.platform != "linux", reason="such names are of Linux alone")
def test_a_name_that_is_no_text_is_shown_by_its_escapes(tmp_path):
    """A workbook whose file's name is no UTF-8 is studied like others."""
    book = tmp_path / os.fsdecode(b"odd\xff.xlsx")
    book.write_bytes(BRACKET.read_bytes())
    words = ["study", str(book), "-o", str(tmp_path / "s.xlsx"), "--generations", "9", "--quiet"]
    words += ["--no-prove", "--html", str(tmp_path / "s.html"), "--data", str(tmp_path / "s.csv")]
    assert main(words) == 0
    assert r"P1 odd\udcff" in (tmp_path / "s.html").read_text(encoding="utf-8")
