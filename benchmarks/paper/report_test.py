#!/usr/bin/env python3
"""Tests of what makes docs/paper/README.md: the page is that of the rows beside it, its tables say what they say."""

import tempfile
import unittest
from pathlib import Path

import report
import rows

REPOSITORY = Path(__file__).resolve().parents[2]
DATA = REPOSITORY / "docs/paper/data"


def tables_of(page):
    """Lists of lines, each a list of fields."""
    tables, last_was_table = [], False
    for line in page.splitlines():
        is_table = line.startswith("|")
        if is_table:
            if not last_was_table:
                tables.append([])
            tables[-1].append([field.strip() for field in line.strip("|").split("|")])
        last_was_table = is_table
    return tables


def registration(**changes):
    return {"pair": "p", "dataset": "Park", "preset": "paper", "right": 1, "rotation_error_deg": 0.1,
            "translation_error_m": 0.02, "centroid_displacement_m": 0.03, "total_s": 0.5} | changes


class Page(unittest.TestCase):
    def test_is_that_of_the_rows(self):
        page = report.page(DATA, (REPOSITORY / "benchmarks/paper/README.template.md").read_text())
        self.assertEqual(page, (REPOSITORY / "docs/paper/README.md").read_text(), "run make paper, or its last line")

    def test_tables_parse(self):
        tables = tables_of((REPOSITORY / "docs/paper/README.md").read_text())
        datasets = rows.in_order(rows.read_rows(DATA / "pairs.csv"), "group")
        self.assertEqual(len(tables), 4 + len(datasets))
        for table in tables:
            self.assertEqual({len(line) for line in table}, {len(table[0])})
            self.assertEqual(set(table[1]), {"---"})
            self.assertNotIn("nan", str(table))

    def test_every_figure_is_there(self):
        page = (REPOSITORY / "docs/paper/README.md").read_text()
        for name in ("growth.svg", "fig3_weights.svg", "fig3_parameters.svg", "fig8_precision_recall.svg",
                     "fig4_iterations.png"):
            self.assertIn(f"]({name})", page)
            self.assertTrue((REPOSITORY / "docs/paper" / name).is_file(), name)

    def test_template_and_tables_must_agree(self):
        self.assertEqual(report.filled("a {{b}}", {"b": "c"}), "a c")
        for values in ({}, {"b": "c", "d": "e"}):
            with self.assertRaises(ValueError):
                report.filled("a {{b}}", values)


class Tables(unittest.TestCase):
    def test_errors_are_means_over_the_right_answers(self):
        runs = [registration(), registration(rotation_error_deg=0.3), registration(right=0, rotation_error_deg=99)]
        line = tables_of(report.errors_table(runs, [], "Park"))[0][2]
        self.assertEqual(line, ["**igsp, paper preset**", "2 of 3", "200", "20.0", "30.0", "0.500", "93.74", "85.12",
                                "81.6"])

    def test_nothing_right_is_a_slash(self):
        line = tables_of(report.errors_table([registration(right=0)], [], "Park"))[0][2]
        self.assertEqual(line[1:5], ["0 of 1", "/", "/", "/"])

    def test_a_run_has_settled_when_both_steps_are_small(self):
        steps = [(1.0, 0.001), (0.01, 0.9), (0.04, 0.004), (0.0, 0.0)]
        run = [{"rotation_step_deg": rotation, "translation_step_m": translation} for rotation, translation in steps]
        self.assertEqual(report.settled_after(run, 0.1), 3)
        self.assertEqual(report.settled_after(run[:2], 0.1), 2)

    def test_a_ragged_table_is_refused(self):
        with self.assertRaises(ValueError):
            report.markdown(["a", "b"], [["1", "2"], ["3"]])

    def test_figures(self):
        for value, text in ((0.01234, "0.0123"), (1.5, "1.50"), (123.4, "123"), (12345.6, "12,346"), (0.0, "-")):
            self.assertEqual(report.figure(value), text)

    def test_says_what_was_left_out(self):
        simulated, real = {"origin": "igsp simulate park"}, {"origin": "facade/s4--s2"}
        self.assertIn("left out", report.left_out([simulated]))
        self.assertEqual(report.left_out([simulated, real]), "")


class Rows(unittest.TestCase):
    def test_rows_come_back(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "rows.csv"
            written = [{"name": "a,b", "count": 3, "share": 0.5, "none": ""}]
            rows.write_rows(path, written)
            self.assertEqual(rows.read_rows(path), written)
            self.assertEqual(list(Path(folder).iterdir()), [path])


if __name__ == "__main__":
    unittest.main()
