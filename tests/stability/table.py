"""Runs the battery of hard cases and prints number, case, figure, asked, measured, margin and verdict.

table.py BUILD_FOLDER [--page FILE] [--long]

The programs print a line for each figure (tests/stability/battery.h); this gathers them. With --page it writes them
between the marks of a page, with the day, the processor and the instruction set, and leaves the rest as it is. Exit 1
where a figure fails, or a program did not end well.
"""

import argparse
import datetime
import pathlib
import re
import subprocess
import sys

HEAD = ("case", "", "figure", "asked", "measured", "margin", "verdict")
BEGIN, END = "<!-- battery: begin -->", "<!-- battery: end -->"


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def target():
    flags = set(re.search(r"^flags\s*:(.*)$", pathlib.Path("/proc/cpuinfo").read_text(), re.M).group(1).split())
    return "avx512" if "avx512f" in flags else "avx2" if "avx2" in flags else "baseline"


def rows_of(program):
    """The figures of a program, and whether it ended well."""
    done = subprocess.run([program, "--gtest_brief=1"], capture_output=True, text=True)
    rows = [line[len("[ case     ]"):].split(" | ") for line in done.stdout.splitlines() if line.startswith("[ case     ]")]
    if done.returncode != 0:
        sys.stderr.write(done.stdout[-4000:] + done.stderr[-4000:])
    return [[cell.strip() for cell in row] for row in rows], done.returncode == 0


def table(rows):
    lines = ["| " + " | ".join(HEAD) + " |", "| " + " | ".join("---" for _ in HEAD) + " |"]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--page", type=pathlib.Path)
    arguments.add_argument("--long", action="store_true", help="the cases that take minutes too")
    asked = arguments.parse_args()
    programs = [asked.build / "tests/stability/stability_test"]
    if asked.long:
        programs.append(asked.build / "tests/stability/stability_long_test")
    rows, well = [], True
    for program in programs:
        found, ended_well = rows_of(program)
        rows, well = rows + found, well and ended_well
    rows.sort(key=lambda row: int(row[0]))
    widths = [max(len(row[k]) for row in rows + [HEAD]) for k in range(len(HEAD))]
    for row in [HEAD] + rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    cases = {row[0] for row in rows}
    missed = [row for row in rows if row[-1] == "missed"]
    failed = [row for row in rows if row[-1] == "FAILS"]
    summary = f"{len(cases)} cases, {len(rows)} figures: {len(rows) - len(missed) - len(failed)} hold, " \
              f"{len(missed)} missed and known, {len(failed)} fail"
    print(summary)
    if asked.page:
        page = asked.page.read_text()
        if BEGIN not in page or END not in page:
            sys.exit(f"{asked.page}: has no lines {BEGIN} and {END}")
        made = [BEGIN, "", f"{datetime.date.today()}, {processor()}, {target()}. {summary}.", ""]
        made += table(rows) + ["", END]
        asked.page.write_text(page[:page.index(BEGIN)] + "\n".join(made) + page[page.index(END) + len(END):])
    sys.exit(0 if well and not failed else 1)


if __name__ == "__main__":
    main()
