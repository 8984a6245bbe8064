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

from break_list import BREAKS

ROOT = pathlib.Path(__file__).resolve().parents[2]
PRESET = "release"
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


class Copy:
    """The sources and their build, apart from the checkout."""

    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs
        self.build, self.logs = folder / "build" / PRESET, folder / "build/logs"

    def sync(self):
        """Makes the files those of the checkout; what is the same keeps its time."""
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, text=True, check=True)
        wanted = {name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()}
        for name in wanted:
            here, there = ROOT / name, self.folder / name
            if there.is_file() and there.read_bytes() == here.read_bytes():
                continue
            there.parent.mkdir(parents=True, exist_ok=True)
            there.write_bytes(here.read_bytes())
            there.chmod(here.stat().st_mode)
        for there in self.folder.rglob("*"):
            name = there.relative_to(self.folder)
            if name.parts[0] != "build" and there.is_file() and str(name) not in wanted:
                there.unlink()
        self.logs.mkdir(parents=True, exist_ok=True)

    def call(self, log, *words):
        done = subprocess.run(words, cwd=self.folder, stdout=log, stderr=subprocess.STDOUT)
        return done.returncode == 0

    def make(self, log, trials):
        targets = sorted({target for trial in trials for target in trial.targets()})
        return self.call(log, "cmake", "--build", self.build, "-j", str(self.jobs), "--target", *targets)


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


def broken_text(broken, text):
    if text.count(broken.find) != 1:
        sys.exit(f"break {broken.name}: what it looks for stands {text.count(broken.find)} times, not once, in "
                 f"{broken.file}; that code has changed: change tests/stability/break_list.py too")
    return text.replace(broken.find, broken.replace)


def try_trial(name, trial, copy, log):
    begun = time.monotonic()
    how, what = trial.run(copy, log)
    print(f"  {name}: case {trial.case} {how}, {time.monotonic() - begun:.0f} s  {what}", flush=True)
    return how, what


def try_break(broken, copy, seconds):
    """{case: what became of it, and what was wrong}"""
    trials, path = trials_of(broken, seconds), copy.folder / broken.file
    original = path.read_text()
    with open(copy.logs / f"{broken.name}.log", "w", buffering=1) as log:
        try:
            path.write_text(broken_text(broken, original))
            begun = time.monotonic()
            if not copy.make(log, trials):
                print(f"  {broken.name}: does not build, see {log.name}", flush=True)
                return {str(trial.case): ("does not build", f"see {log.name}") for trial in trials}
            print(f"  {broken.name}: built, {time.monotonic() - begun:.0f} s", flush=True)
            return {str(trial.case): try_trial(broken.name, trial, copy, log) for trial in trials}
        finally:
            path.write_text(original)


def try_unbroken(broken, copy, seconds):
    """What the unbroken engine does not pass."""
    trials = sorted({trial for one in broken for trial in trials_of(one, seconds)}, key=lambda trial: trial.case)
    wrong = []
    with open(copy.logs / "unbroken.log", "w", buffering=1) as log:
        if not copy.make(log, trials):
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


def write_page(page, rows, summary):
    text = page.read_text()
    if BEGIN not in text or END not in text:
        sys.exit(f"{page}: has no lines {BEGIN} and {END}")
    made = [BEGIN, "", f"{datetime.date.today()}. {summary}", "", "| " + " | ".join(HEAD) + " |"]
    made += ["| " + " | ".join("---" for _ in HEAD) + " |"] + ["| " + " | ".join(row) + " |" for row in rows]
    page.write_text(text[:text.index(BEGIN)] + "\n".join(made + ["", END]) + text[text.index(END) + len(END):])


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
        if not (copy.call(log, "cmake", "--preset", PRESET, "-DREPOSE_TESTS=ON") and copy.make(log, all_trials)):
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
        write_page(asked.page, rows, summary)
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
