"""Runs a small scene while one call fails: of writing, syncing, renaming, creating, or allocating (fail_nth.c). Whatever
fails, the run ends with the right code and words, leaves no torn file and no temporary, and goes on to the same bits.

faults.py PROGRAM LIBRARY [KIND...] [--every N] [--random N] [--jobs N]
  KIND      write, sync, rename, create, allocate, site; all if none is named. site: of allocations the first from each
            place of the program, a place being who calls, and who calls that, four calls deep
  --every   only every Nth call
  --random  of allocations: so many of them, drawn with a fixed seed, in place of every Nth
"""
import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile

SCENE = {
    "repose": 1, "name": "tiny", "grid": {"spacing": 0.02}, "time": {"frames_per_second": 100, "frames": 3},
    "materials": {"sand": {"type": "drucker_prager"}},
    "output": {"surface": {}, "fog": {}, "ply": True, "vtp": True},
    "bodies": [{"name": "box", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0.02, 0], "upper": [0.1, 0.12, 0.1]}}],
    "probes": [{"name": "all", "type": "energy"}],
    "colliders": [{"name": "ground", "shape": {"type": "plane"}, "friction": 0.4}],
}
KINDS = ("write", "sync", "rename", "create", "allocate", "site")
CODES = {"allocate": (78,), "site": (78,)}  # of an end that is told; others are errors of output
OF_OUTPUT = (73, 74)
LIMIT = 60  # s


class Trial:
    """A run in a folder of its own, with what is right for it."""

    def __init__(self, options, scene, folder):
        self.options, self.scene, self.folder = options, scene, pathlib.Path(folder)
        self.out = self.folder / "out"

    def run(self, *words, fail=None):
        environment = dict(os.environ)
        if fail:
            environment.update(LD_PRELOAD=self.options.library, FAIL_NTH=fail, FAIL_NTH_FOLDER=str(self.out),
                               FAIL_NTH_COUNT=str(self.folder / "count"))
        return subprocess.run([self.options.program, "run", self.scene, "--out", self.out, "--threads", "2", "--quiet",
                               *words], env=environment, capture_output=True, text=True, timeout=LIMIT)

    def contents(self):
        """Of the caches, by name."""
        return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(self.out.glob("tiny.*.0*"))
                if path.suffix != ".checkpoint"}

    def last_hash(self):
        return json.loads((self.out / "run.json").read_text())["frames"][-1]["hash"]


def whole(trial, reference):
    """What is wrong with the files that a run has left."""
    wrong = []
    if not trial.out.exists():
        return wrong
    for path in trial.out.iterdir():
        if ".tmp" in path.name:
            wrong.append(f"{path.name} is left")
    for name, digest in trial.contents().items():
        if digest != reference["contents"].get(name):
            wrong.append(f"{name} has other bytes")
    log = trial.out / "run.json"
    if log.exists():
        json.loads(log.read_text())
    return wrong


def attempt(options, scene, reference, kind, number):
    """What is wrong, or an empty text."""
    with tempfile.TemporaryDirectory() as folder:
        trial = Trial(options, scene, folder)
        first = trial.run(fail=f"{kind} {number}")
        told = f"{kind} {number}: exit code {first.returncode}, {first.stderr.strip()[:300]!r}"
        allowed = (0, *CODES.get(kind, OF_OUTPUT))
        if first.returncode not in allowed:
            return told
        if first.returncode != 0 and "repose: error: " not in first.stderr:
            return f"{told}: without a word"
        wrong = whole(trial, reference)
        if wrong:
            return f"{told}: {', '.join(wrong)}"
        if first.returncode == 0:
            return "" if trial.contents() == reference["contents"] else f"{told}: a file is missing, and nobody said so"
        again = trial.run("--resume" if (trial.out / "run.json").exists() else "--overwrite")
        if again.returncode == 66 and "no checkpoint" in again.stderr:
            again = trial.run("--overwrite")
        if again.returncode != 0:
            return f"{told}: resumed with {again.returncode}, {again.stderr.strip()[:300]!r}"
        if trial.last_hash() != reference["hash"] or trial.contents() != reference["contents"]:
            missing = sorted(set(reference["contents"]) - set(trial.contents()))
            return f"{told}: resumed to other bits; missing: {missing}"
    return ""


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("program")
    arguments.add_argument("library")
    arguments.add_argument("kinds", nargs="*")
    arguments.add_argument("--every", type=int, default=1)
    arguments.add_argument("--random", type=int)
    arguments.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    options = arguments.parse_args()
    failures, tried = [], 0
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "tiny.json")
        pathlib.Path(scene).write_text(json.dumps(SCENE))
        faults = {}
        for kind in options.kinds or KINDS:
            trial = Trial(options, scene, os.path.join(folder, kind))
            trial.folder.mkdir()
            done = trial.run(fail=f"{kind} 0")
            if done.returncode != 0:
                sys.exit(f"without a fault: {done.stderr}")
            told = [int(line) for line in (trial.folder / "count").read_text().split()]
            faults[kind] = sorted(told) if kind == "site" else range(1, told[0] + 1)
            reference = {"contents": trial.contents(), "hash": trial.last_hash()}
        jobs = []
        for kind, numbers in faults.items():
            if kind == "allocate" and options.random:
                numbers = sorted(random.Random(1).sample(numbers, min(len(numbers), options.random)))
            jobs += [(kind, number) for number in numbers[::options.every]]
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            waiting = [pool.submit(attempt, options, scene, reference, *job) for job in jobs]
            for done in waiting:
                tried += 1
                try:
                    text = done.result()
                except subprocess.TimeoutExpired as error:
                    text = f"hangs: {error}"
                if text:
                    failures.append(text)
                    print(text, flush=True)
    counts = {kind: len(numbers) for kind, numbers in faults.items()}
    if not tried or not all(counts.values()):
        sys.exit(f"nothing was counted: {counts}")
    print(f"{tried} faults of {counts}: {len(failures)} wrong")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
