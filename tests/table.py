"""Runs the tests that ask for figures and prints what was asked, what was measured and the verdict as a table.

table.py battery|laws BUILD_FOLDER [--page FILE] [--long]

The programs print a line of cells for each figure (tests/figures.h); this gathers them: the battery of hard cases,
or the laws of the validation. With --page it writes them between the marks of a page, with the day, the processor
and the instruction set, and leaves the rest as it is. Exit 1 where a figure fails, or a program did not end well.
"""

import argparse
import dataclasses
import datetime
import pathlib
import re
import subprocess
import sys

from marked_page import put_between, table
from processor import processor


@dataclasses.dataclass
class Kind:
    """What a table is gathered from."""
    line: str        # what its lines begin with
    head: tuple
    programs: tuple  # of (program, which of its tests)
    long: tuple      # further ones that take minutes
    counted: str     # what the first cells are
    good: str        # the word for what holds
    by_number: bool  # sorted by the first cell; else in the order of the programs


KINDS = {
    "battery": Kind("case", ("case", "", "figure", "asked", "measured", "margin", "verdict"),
                    (("stability/stability_test", "*"),), (("stability/stability_long_test", "*"),),
                    "cases", "hold", True),
    # Cases of the battery that are laws too.
    "laws": Kind("law", ("law", "source", "figure", "band", "measured", "control", "its figure", "verdict"),
                 (("physics/physics_test", "Validation.*"), ("element/element_test", "Validation.*"),
                  ("stability/stability_test", "Battery.Case30_Above*:Battery.Case33_*:Battery.Case34_*")), (),
                 "laws", "within their bands", False),
}


def target():
    flags = set(re.search(r"^flags\s*:(.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M).group(1).split())
    return "avx512" if "avx512f" in flags else "avx2" if "avx2" in flags else "baseline"


def rows_of(program, tests, kind):
    """The figures of a program, and whether it ended well."""
    done = subprocess.run([program, "--gtest_brief=1", f"--gtest_filter={tests}"], capture_output=True, text=True)
    begin = f"[ {kind.line:9}]"
    rows = [line[len(begin):].split(" | ") for line in done.stdout.splitlines() if line.startswith(begin)]
    if done.returncode != 0:
        sys.stderr.write(done.stdout[-4000:] + done.stderr[-4000:])
    return [[cell.strip() for cell in row] for row in rows], done.returncode == 0


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("kind", choices=KINDS)
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--page", type=pathlib.Path)
    arguments.add_argument("--long", action="store_true", help="the cases that take minutes too")
    asked = arguments.parse_args()
    kind = KINDS[asked.kind]
    rows, well = [], True
    for program, tests in kind.programs + (kind.long if asked.long else ()):
        found, ended_well = rows_of(asked.build / "tests" / program, tests, kind)
        rows, well = rows + found, well and ended_well
    if kind.by_number:
        rows.sort(key=lambda row: int(row[0]))
    widths = [max(len(row[k]) for row in rows + [kind.head]) for k in range(len(kind.head))]
    for row in [kind.head] + rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    counted = {row[0] for row in rows}
    missed = [row for row in rows if row[-1] == "missed"]
    failed = [row for row in rows if row[-1] == "FAILS"]
    summary = f"{len(counted)} {kind.counted}, {len(rows)} figures: {len(rows) - len(missed) - len(failed)} " \
              f"{kind.good}, {len(missed)} missed and known, {len(failed)} fail"
    print(summary)
    if asked.page:
        put_between(asked.page, f"<!-- {asked.kind}: begin -->", f"<!-- {asked.kind}: end -->",
                    [f"{datetime.date.today()}, {processor()}, {target()}. {summary}.", "", *table(kind.head, rows)])
    sys.exit(0 if well and not failed else 1)


if __name__ == "__main__":
    main()
