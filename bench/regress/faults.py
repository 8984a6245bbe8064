"""Shows that the gate notices what it is there for, and nothing else.

faults.py [--only NAME ...] [--times N] [--page FILE] [--copy DIR] [--jobs N]

A copy of the sources is built, and measured against bench/baselines: the gate must find nothing, as often as --times says,
and with each fault of fault_list.py by itself it must find the figure that the fault is about, as often.
--page writes the table between the marks of a page. Exit 1 where something was not noticed, or was seen that is not there.
"""

import argparse
import datetime
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1] / "tests"))
from broken_copy import Copy, ROOT
from fault_list import FAULTS
from marked_page import put_between, table

BEGIN, END = "<!-- faults: begin -->", "<!-- faults: end -->"
HEAD = ("fault", "asked", "noticed", "what told of it")
PROGRAM = "apps/repose/repose"


class Gate:
    def __init__(self, copy):
        self.copy, self.program = copy, copy.build / PROGRAM
        self.good = copy.build.parent / "good"  # the program without faults

    def call(self, *words):
        done = subprocess.run([sys.executable, HERE / "regress.py", *map(str, words)], capture_output=True, text=True)
        if done.returncode not in (0, 1):
            sys.exit(done.stdout + done.stderr)
        return done.returncode, done.stdout

    def measure(self, *words):
        timer = next(self.copy.build.rglob("libno_timer.so"))
        return self.call("gate", self.program, "--no-timer", timer, "--baselines", ROOT / "bench/baselines", *words)

    def of_fault(self, fault):
        if fault.paired:
            return self.call("ab", self.good, self.program, "--only", fault.cases)
        return self.measure("--only", fault.cases, "--no-caches")  # no fault is told by caches alone


def build(copy, log):
    if not copy.make(log, ["repose", "no_timer"]):
        sys.exit(f"the copy does not build: see {log.name}")


def try_fault(fault, gate, copy, times):
    """How often it was noticed, and by which line."""
    with open(copy.logs / f"fault_{fault.name}.log", "w") as log, copy.broken(fault):
        build(copy, log)
        seen, line = 0, ""
        for _ in range(times):
            code, told = gate.of_fault(fault)
            found = re.search(fault.told, told, re.M)
            log.write(told)
            if code == 1 and found:
                seen, line = seen + 1, told[found.start():].splitlines()[0]
    print(f"{fault.name}: noticed {seen} of {times}  {line}", flush=True)
    return [fault.what, f"{times} of {times}", f"{seen} of {times}", re.sub(r"\s+", " ", line).replace("|", "").strip()], seen == times


def try_none(gate, times):
    quiet = 0
    for _ in range(times):
        asked = gate.measure("--quick"), gate.call("ab", gate.good, gate.good, "--only", "bare")
        quiet += all(code == 0 for code, _ in asked)
        for code, told in asked:
            if code != 0:
                print(told)
    print(f"none: nothing seen in {quiet} of {times}", flush=True)
    return ["none, with every figure of the quick part and `--ab`", f"0 of {times}", f"{times - quiet} of {times}", ""], quiet == times


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--only", nargs="+", metavar="NAME", help="these faults; \"none\" is none")
    arguments.add_argument("--times", type=int, default=10)
    arguments.add_argument("--page", type=pathlib.Path)
    arguments.add_argument("--copy", type=pathlib.Path, default=ROOT / "build/faults", help="where the copy lives")
    arguments.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    asked = arguments.parse_args()
    chosen = [fault for fault in FAULTS if not asked.only or fault.name in asked.only]
    copy = Copy(asked.copy.resolve(), asked.jobs)
    copy.sync()
    with open(copy.logs / "build.log", "w") as log:
        if not copy.configure(log):
            sys.exit(f"the copy cannot be configured: see {log.name}")
        build(copy, log)
    gate = Gate(copy)
    shutil.copy2(gate.program, gate.good)
    results = [] if asked.only and "none" not in asked.only else [try_none(gate, asked.times)]
    results += [try_fault(fault, gate, copy, asked.times) for fault in chosen]
    with open(copy.logs / "build.log", "a") as log:
        build(copy, log)
    if asked.page:
        rows = [row for row, _ in results]
        put_between(asked.page, BEGIN, END, [f"{datetime.date.today()}.", "", *table(HEAD, rows)])
    sys.exit(0 if all(good for _, good in results) else 1)


if __name__ == "__main__":
    main()
