"""What `repose plan` tells of a grid's error.
  python3 bench/accuracy.py rows STUDY.json...  the rows of engine/base/accuracy.h, of studies of columns
  python3 bench/accuracy.py expected [REPOSE]   what is told of five scenes that were in no study, and what they err by
Studies of the latter lie in out/studies (STUDY_OUT) and go on where they were ended. Exit codes: 0, 1 where four of five do
not hold, 2 where nothing could be measured."""
import json
import math
import os
import re
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "tests"))
from marked_page import replace_between

HEADER = "engine/base/accuracy.h"
BEGIN, END = "    // accuracy: begin\n", "    // accuracy: end\n"
MARGIN = 4  # what is told may be so many times what is measured


class CannotMeasure(Exception):
    pass


def run(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        raise CannotMeasure(f"{' '.join(words)}: exit code {done.returncode}\n{done.stderr[-2000:]}")
    return done.stdout


def study_of(path):
    with open(path) as text:
        return json.load(text)


def cells_along_an_edge(point, particles_per_cell, plane):
    cells = point["particles"] / particles_per_cell
    return math.sqrt(cells) if plane else math.cbrt(cells)


def rows(paths):
    """Of the default transfer alone; what gave out, or lies under the noise, tells nothing."""
    found = []
    for path in paths:
        study = study_of(path)
        plane = "plane" in study["scene"]["name"]
        for number, point in enumerate(study["points"]):
            heap = point["figures"]["heap"]
            if point["state"] != "complete" or number == study["finest"] or heap["under_twice_the_floor"]:
                continue
            if point["settings"].get("grid.transfer", "mls_apic") != "mls_apic":
                continue
            given = [value for key, value in point["settings"].items() if key.endswith("particles_per_cell")]
            per_cell = int(given[0]) if given else 9 if plane else 8
            found.append((cells_along_an_edge(point, per_cell, plane), heap["error"]))
    # Of neighbours closer than a fifth the larger error counts, or what goes between them would not follow a power.
    kept = []
    for cells, error in sorted(found):
        if kept and cells < 1.2 * kept[-1][0]:
            kept[-1] = (kept[-1][0], max(kept[-1][1], error))
        else:
            kept.append((cells, error))
    table = "".join(f"    {{{cells:.1f}, {error:.3f}}},\n" for cells, error in kept)
    replace_between(HEADER, BEGIN, END, table)
    print(table, end="")
    return 0


class Scene:
    """The grid that is asked about, and one that is finer and stands in for the truth, by values of one parameter."""

    def __init__(self, name, path, key, value, finer, *more, plane=False, width=0.0):
        self.name, self.path, self.key, self.value, self.finer, self.more = name, path, key, value, finer, more
        heap = {"name": "heap", "type": "profile", "form": "plane" if plane else "round", "width": width}
        self.figures = "study.figures=" + json.dumps([heap])


SCENES = [
    Scene("tall column", "apps/scenes/column.json", "parameters.cells", 8, 20, "parameters.aspect=2", width=0.0375),
    Scene("flat column of 20 degrees", "apps/scenes/column.json", "parameters.cells", 10, 24, "parameters.aspect=0.5",
          "parameters.phi=20", width=0.03),
    Scene("plane column of 40 degrees", "bench/studies/plane_column.json", "parameters.cells", 10, 40, "parameters.aspect=1",
          "materials.sand.friction_angle=40", plane=True, width=0.01),
    Scene("lifted cylinder", "apps/scenes/friction_angle.json", "parameters.coarse", 2.5, 1.25, "parameters.ppc=8",
          width=0.0025),
    Scene("spout", "apps/scenes/spout.json", "parameters.coarse", 2.5, 1.25, "parameters.ppc=8", width=0.002),
]


def settings(words):
    return [part for word in words for part in ("--set", word)]


def measure(repose, scene):
    told = run([repose, "plan", scene.path, *settings(scene.more), "--set", f"{scene.key}={scene.value}"])
    expected = float(re.search(r"at most about ([\d.e+-]+) % of a heap's outline", told).group(1)) / 100
    folder = os.path.join(os.environ.get("STUDY_OUT", "out/studies"), "expected", scene.name.replace(" ", "_"))
    run([repose, "study", scene.path, "--out", folder, *settings([*scene.more, scene.figures]), "--vary",
         f"{scene.key}={scene.value}", "--reference", f"finest:{scene.key}={scene.finer}", "--reference-seeds", "1",
         "--seeds", "2", "--repeat", "1", "--any-build", "--quiet"])
    study = study_of(os.path.join(folder, "study.json"))
    asked = [point for number, point in enumerate(study["points"]) if number != study["finest"]]
    return expected, asked[0]["figures"]["heap"]["error"]


def expected(repose):
    print("| Scene | Told, at most about | Measured | Told over measured |\n| --- | --- | --- | --- |")
    hold = 0
    for scene in SCENES:
        told, error = measure(repose, scene)
        hold += error <= told <= MARGIN * error
        print(f"| {scene.name}, {scene.key.split('.')[1]} {scene.value}, against {scene.finer} | {100 * told:.2g} % | "
              f"{100 * error:.2g} % | {told / error:.2g} |", flush=True)
    print(f"\n{hold} of {len(SCENES)} lie between 1 and {MARGIN}.")
    return 0 if hold >= 4 else 1


def main():
    words = sys.argv[1:]
    try:
        if words[:1] == ["rows"] and len(words) > 1:
            return rows(words[1:])
        if words[:1] == ["expected"] and len(words) <= 2:
            return expected(words[1] if len(words) > 1 else "build/release/apps/repose/repose")
    except (CannotMeasure, OSError) as error:
        print(f"accuracy: could not measure: {error}", file=sys.stderr)
        return 2
    print(__doc__, file=sys.stderr)
    return 64


if __name__ == "__main__":
    sys.exit(main())
