"""A result as JSON, CSV, Markdown and in terminals of two widths."""

import csv
import json
from io import StringIO

import numpy as np
import pytest
from rich.console import Console

from verify.report.result import Column, Table, to_json


def test_json_keeps_values(made_result):
    data = json.loads(to_json(made_result.to_dict()))
    first = data["tables"][0]
    assert data["summary"] == made_result.summary
    assert data["z"] == {"re": 1.5, "im": -2.5}
    assert first["rows"][0] == {"mode": 1, "model": "segment", "frequency": 443.25, "error": -0.0021}
    assert first["rows"][2]["frequency"] is None
    assert data["warnings"] == ["Mode 5 is not converged."]


def test_numpy_values_are_json():
    value = {"a": np.arange(3), "b": np.float64(0.5), "c": np.int64(7), "d": (np.inf, -1.0)}
    assert json.loads(to_json(value)) == {"a": [0, 1, 2], "b": 0.5, "c": 7, "d": [None, -1.0]}


def test_csv_is_in_si_units(made_result):
    head, first, second, _ = csv.reader(StringIO(made_result.tables[0].csv()))
    assert head == ["mode", "model", "frequency, Hz", "error"]
    assert float(first[3]) == -0.0021
    assert second[3] == ""


def test_markdown_escapes_bars(made_result):
    lines = made_result.tables[0].markdown().splitlines()
    assert lines[0] == "| mode | model | frequency, Hz | error, % |"
    assert "a\\|b" in lines[4]
    assert lines[2].count("|") == 5


@pytest.mark.parametrize("width", [80, 120])
def test_terminal_tables_fit(width):
    rows = [
        (n, "segments with a long name of the model", *(1.23456789e-5 * n * k for k in range(1, 12))) for n in (1, 2)
    ]
    columns = [Column("N"), Column("model"), *(Column(f"value {k}", "Hz", ".9g") for k in range(1, 12))]
    out = StringIO()
    Table("Wide", columns, rows).print(Console(file=out, width=width))
    text = out.getvalue()
    assert max(map(len, text.splitlines())) <= width
    assert text.count("…") == 0
    assert all(cell in text for row in Table("", columns, rows).text_rows() for cell in row[2:])
