"""Shows that each case of the battery notices a broken engine.

breaks.py [--only NAME ...] [--page FILE] [--long] [--copy DIR] [--jobs N] [--minutes N]

A copy of the sources is built once. Each break of break_list.py is applied to it by itself, what it touches is
built again, and the tests of its cases are run: each of these cases must fail; to crash, or not to come to an end
in time, is to fail too. At the end the unbroken engine must pass the same tests in the same time. Logs, and what
was found, stand in build/logs of the copy; --only tries some breaks again and keeps what was found of the others.
--page writes all of it between the marks of a page. --long has the breaks that need a second build too. Exit 1
where a case did not fail, has no break, or fails with the unbroken engine.
"""

import argparse
import dataclasses
import datetime
import hashlib
import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from break_list import BREAKS
from broken_copy import Copy, ROOT, broken_text
from marked_page import put_between, table

BEGIN, END = "<!-- breaks: begin -->", "<!-- breaks: end -->"
HEAD = ("break", "what", "cases seen failing")
EFFECTS, RESCALING, SOAK = 46, 50, 43  # cases whose tests have names, or a program, of their own
SEEN = ("failed", "crashed", "did not end")
MOST_MEMORY = 16 << 30  # bytes; a broken engine may ask for all there is


def numbered_cases():
    """Of all that have a test."""
    text = "".join(path.read_text() for path in (ROOT / "tests/stability").glob("*.cpp"))
    return {int(number) for number in re.findall(r"\bCase(\d\d)_", text)} | {EFFECTS, RESCALING}


def digest(broken):
    """Of a break, so that what was found of another wording of it is not taken for this one's."""
    return hashlib.sha256(json.dumps(dataclasses.asdict(broken), sort_keys=True).encode()).hexdigest()[:16]


@dataclasses.dataclass(frozen=True)
class Trial:
    """The tests of one case."""
    case: int
    seconds: float

    def targets(self):
        own = {EFFECTS: ["repose", "no_timer"], SOAK: ["stability_long_test"]}
        return own.get(self.case, ["stability_test"])

    def command(self, copy):
        if self.case == EFFECTS:
            # The second build lies as deep as the first, so that ccache knows what both have.
            return ["bash", copy.folder / "tests/effects/off_costs_nothing.sh", copy.folder,
                    copy.folder / "build/bare", copy.build / "apps/repose/repose",
                    copy.build / "tests/effects/libno_timer.so", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"]
        begin = "Rescaling_" if self.case == RESCALING else f"Case{self.case:02}_"
        # They end with the first figure that fails, by a signal.
        return [copy.build / "tests/stability" / self.targets()[0], f"--gtest_filter=Battery*.{begin}*",
                "--gtest_break_on_failure"]

    def run(self, copy, log):
        """What became of it, and the first thing that was wrong."""
        process = subprocess.Popen(self.command(copy), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                   errors="replace", start_new_session=True)
        try:
            said, _ = process.communicate(timeout=self.seconds)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            said, _ = process.communicate()
            log.write(said)
            return "did not end", f"within {self.seconds:g} s"
        log.write(said)
        if self.case != EFFECTS and "[ RUN      ]" not in said:
            return "has no test", ""
        if process.returncode == 0:
            return "passed", ""
        told = re.search(r"^case \d+, (.*)$", said, re.M) or re.search(r": Failure\n(.*)$", said, re.M)
        crashed = process.returncode < 0 and process.returncode != -signal.SIGTRAP
        what = told[1] if told else f"exit code {process.returncode}"
        return "crashed" if crashed else "failed", what


def trials_of(broken, seconds):
    return [Trial(case, 3600.0 if broken.long else seconds) for case in broken.cases]


def try_trial(name, trial, copy, log):
    begun = time.monotonic()
    how, what = trial.run(copy, log)
    print(f"  {name}: case {trial.case} {how}, {time.monotonic() - begun:.0f} s  {what}", flush=True)
    return how, what


def targets_of(trials):
    return sorted({target for trial in trials for target in trial.targets()})


def try_break(broken, copy, seconds):
    """{case: what became of it, and what was wrong}"""
    trials = trials_of(broken, seconds)
    with open(copy.logs / f"{broken.name}.log", "w", buffering=1) as log, copy.broken(broken):
        begun = time.monotonic()
        if not copy.make(log, targets_of(trials)):
            print(f"  {broken.name}: does not build, see {log.name}", flush=True)
            return {str(trial.case): ("does not build", f"see {log.name}") for trial in trials}
        print(f"  {broken.name}: built, {time.monotonic() - begun:.0f} s", flush=True)
        return {str(trial.case): try_trial(broken.name, trial, copy, log) for trial in trials}


def try_unbroken(broken, copy, seconds):
    """What the unbroken engine does not pass."""
    trials = sorted({trial for one in broken for trial in trials_of(one, seconds)}, key=lambda trial: trial.case)
    wrong = []
    with open(copy.logs / "unbroken.log", "w", buffering=1) as log:
        if not copy.make(log, targets_of(trials)):
            sys.exit(f"the unbroken engine does not build: see {log.name}")
        for trial in trials:
            how, what = try_trial("unbroken", trial, copy, log)
            if how != "passed":
                wrong.append(f"case {trial.case} with the unbroken engine: {how} {what}")
    return wrong


def row_of(broken, found):
    cells = []
    for case in broken.cases:
        how = found.get(str(case), ["not run"])[0]
        cells.append(str(case) if how == "failed" else f"{case} ({how})")
    return [broken.name, broken.what, ", ".join(cells)]


def parse():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--only", nargs="+", metavar="NAME", help="these breaks")
    arguments.add_argument("--page", type=pathlib.Path)
    arguments.add_argument("--long", action="store_true", help="those that need a second build too")
    arguments.add_argument("--copy", type=pathlib.Path, default=ROOT / "build/breaks", help="where the copy lives")
    arguments.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    arguments.add_argument("--minutes", type=float, default=10.0, help="that the tests of a case may take")
    asked = arguments.parse_args()
    unknown = set(asked.only or []) - {broken.name for broken in BREAKS}
    if unknown:
        sys.exit(f"no break has the name {', '.join(sorted(unknown))}; there are "
                 + ", ".join(broken.name for broken in BREAKS))
    return asked


def main():
    asked = parse()
    seconds = 60.0 * asked.minutes
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))
    chosen = [broken for broken in BREAKS
              if (broken.name in asked.only if asked.only else asked.long or not broken.long)]
    for broken in BREAKS:
        broken_text(broken, (ROOT / broken.file).read_text())
    copy = Copy(asked.copy.resolve(), asked.jobs)
    copy.sync()
    with open(copy.logs / "build.log", "w") as log:
        all_trials = [trial for broken in chosen for trial in trials_of(broken, seconds)]
        if not (copy.configure(log) and copy.make(log, targets_of(all_trials))):
            sys.exit(f"the copy does not build: see {log.name}")
    kept = copy.logs / "found.json"
    found = json.loads(kept.read_text()) if asked.only and kept.exists() else {}
    for broken in chosen:
        found[digest(broken)] = try_break(broken, copy, seconds)
        kept.write_text(json.dumps(found, indent=1))
    wrong = try_unbroken(chosen, copy, seconds)

    cases, has_break = numbered_cases(), {case for broken in BREAKS for case in broken.cases}
    wrong += [f"case {case} has no break in tests/stability/break_list.py" for case in sorted(cases - has_break)]
    for broken in chosen:
        wrong += [f"case {case} does not notice {broken.name}, {broken.what}: {how} {what}"
                  for case, (how, what) in found[digest(broken)].items() if how not in SEEN]
    all_found = [(broken, found.get(digest(broken), {})) for broken in BREAKS]
    rows = [row_of(broken, of_it) for broken, of_it in all_found]
    seen = {case for _, of_it in all_found for case, (how, _) in of_it.items() if how in SEEN}
    summary = f"{len(seen)} of {len(cases)} cases seen failing, by {len(BREAKS)} breaks."
    for broken, row in zip(BREAKS, rows):
        if broken in chosen:
            print(f"{row[0]:22}{row[2]:30}  {row[1]}")
    print("\n".join([summary] + wrong))
    if asked.page:
        put_between(asked.page, BEGIN, END, [f"{datetime.date.today()}. {summary}", "", *table(HEAD, rows)])
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
