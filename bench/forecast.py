"""What a step would gain from more cores than this machine has: a forecast, no measurement.
  python3 bench/forecast.py [--repose FILE] [--bandwidth GB/s] [--wake US] [--page docs/benchmarks.md]
What a particle and a block take in each phase is measured here, on one core; blocks are those of scenes under way; a
step's loops are then scheduled as threads take blocks (list scheduling: the next block to whoever is free), one colour of
the scatter after the other, each no faster than its bytes come from memory. Exit codes: 0, 2 where nothing could be
measured."""
import argparse
import collections
import datetime
import heapq
import json
import math
import pathlib
import re
import sys
import tempfile

import numpy

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE / "regress"), str(HERE.parent / "tests")]
import measure
from marked_page import put_between, table

BEGIN, END = "<!-- forecast: begin -->", "<!-- forecast: end -->"
SCENES = {"probe_column": 3, "hourglass": 20, "shovel": 30}  # and the frame at which its blocks are looked at
CORES = (1, 2, 16, 64, 128)
PHASES = ("scatter", "nodes", "gather")
# Of dry sand with mls_apic in single precision, of bench/work.cpp: what passes over particles move between memory and
# core, B; of nodes what a block has.
BYTES = {"scatter": (60 + 24, 4096), "nodes": (0, 2048), "gather": (108 + 48 + 48 + 36, 1024)}
CORE_BANDWIDTH = 37.0  # GB/s that a core draws by itself (docs/benchmarks.md, memory read)
BLOCK_CELLS = 4

Block = collections.namedtuple("Block", "colour particles")


def run(words):
    measure.run([str(word) for word in words])


def scene_path(name):
    return HERE.parent / "apps/scenes" / f"{name}.json"


def bench(repose, name, threads, *overrides):
    """Median of three, by the time of the step."""
    with tempfile.TemporaryDirectory() as out:
        found = []
        for k in range(3):
            file = f"{out}/{k}.json"
            run([repose, "bench", scene_path(name), "--steps", 40, "--threads", threads, "--json", file,
                 *(word for override in overrides for word in ("--set", override))])
            with open(file) as text:
                found.append(json.load(text))
        return sorted(found, key=lambda one: one["ns_per_particle_step"])[1]


def costs(repose):
    """Of each phase: ns per particle and ns per block, from one column with several numbers of particles per cell."""
    rows, times = [], {phase: [] for phase in PHASES}
    for per_cell in (1, 4, 8, 16):
        made = bench(repose, "probe_column", 1, f"bodies.column.particles_per_cell={per_cell}")
        rows.append((made["particles"], made["blocks"]))
        for phase in PHASES:
            times[phase].append(made["phases"][phase] * made["particles"])
    weights = 1.0 / numpy.array([row[0] for row in rows])
    fitted = {}
    for phase in PHASES:
        solved = numpy.linalg.lstsq(numpy.array(rows) * weights[:, None], numpy.array(times[phase]) * weights, rcond=None)[0]
        fitted[phase] = tuple(max(0.0, float(value)) for value in solved)
    return fitted


def read_points(path):
    """Positions of a binary PLY file."""
    content = path.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    head = content[:end].decode()
    kinds = {"float": "<f4", "double": "<f8", "uint": "<u4", "int": "<i4", "uchar": "u1"}
    layout = numpy.dtype([(name, kinds[kind]) for kind, name in re.findall(r"property (\w+) (\w+)", head)])
    points = numpy.frombuffer(content, layout, int(re.search(r"element vertex (\d+)", head).group(1)), end)
    return numpy.stack([points[axis].astype(float) for axis in "xyz"], axis=1)


def blocks_of(repose, name, frame):
    """Of a scene after some frames: blocks in the order of the engine, with their colours."""
    with tempfile.TemporaryDirectory() as out:
        run([repose, "run", scene_path(name), "--frames", f"1-{frame}", "--out", f"{out}/run", "--quiet", "--set",
             "output.ply=true", "--set", "output.vdb=false", "--set", "output.checkpoint=false"])
        spacing = json.loads((pathlib.Path(out) / "run/run.json").read_text())["scene"]["spacing"]
        last = sorted((pathlib.Path(out) / "run").glob("*.ply"))[-1]
        blocks, counts = numpy.unique(numpy.floor(read_points(last) / (BLOCK_CELLS * spacing)).astype(int), axis=0,
                                      return_counts=True)
    return [Block(int(b[0] % 2 * 4 + b[1] % 2 * 2 + b[2] % 2), int(n)) for b, n in zip(blocks, counts)]


def schedule(tasks, cores):
    """When the last of the cores is done, ns; each takes the next task when it is free."""
    free = [0.0] * min(cores, max(1, len(tasks)))
    for task in tasks:
        heapq.heapreplace(free, free[0] + task)
    return max(free)


class Machine:
    def __init__(self, cores, bandwidth, wake):
        self.cores, self.bandwidth = cores, min(cores * CORE_BANDWIDTH, bandwidth)
        # Threads wake one another, as a tree.
        self.wake = 1e3 * wake * math.log2(cores) if cores > 1 else 0.0


def step(blocks, cost, machine):
    """ns of a step, and what its parts lose beyond an even share of the work: {cause: ns}."""
    total, lost = 0.0, collections.Counter()
    for phase in PHASES:
        particle, block = cost[phase]
        colours = range(8) if phase == "scatter" else (None,)
        for colour in colours:
            mine = [b for b in blocks if colour is None or b.colour == colour]
            tasks = [particle * b.particles + block for b in mine]
            even, done = sum(tasks) / machine.cores, schedule(tasks, machine.cores)
            moved = sum(BYTES[phase][0] * b.particles + BYTES[phase][1] for b in mine) / machine.bandwidth
            total += max(done, moved) + machine.wake
            lost["too few blocks"] += done - even
            lost["memory"] += max(0.0, moved - done)
            lost["waking"] += machine.wake
    return total, lost


def forecast(options):
    cost = costs(options.repose)
    lines = [f"{datetime.date.today()}. **A forecast.** Measured on one core here, ns per particle and per block: "
             + ", ".join(f"{phase} {cost[phase][0]:.1f} and {cost[phase][1]:.0f}" for phase in PHASES)
             + f". Assumed: {options.bandwidth:.0f} GB/s for all cores together, {options.wake:g} us times the binary "
               "logarithm of the cores to wake them for a loop, of which a step has ten.", ""]
    rows = []
    for name, frame in SCENES.items():
        blocks = blocks_of(options.repose, name, frame)
        particles = sum(block.particles for block in blocks)
        alone = step(blocks, cost, Machine(1, options.bandwidth, options.wake))[0]
        measured = bench(options.repose, name, 1)["ns_per_particle_step"] / bench(options.repose, name, 2)["ns_per_particle_step"]
        cells = [name, str(particles), str(len(blocks))]
        for cores in CORES[1:]:
            took, lost = step(blocks, cost, Machine(cores, options.bandwidth, options.wake))
            cause, most = max(lost.items(), key=lambda item: item[1])
            told = f"{alone / took:.2f}" if cores == 2 else f"{alone / took:.0f}"
            cells.append(told + (f" ({cause}, {100 * most / took:.0f} %)" if cores > 2 else f" (measured {measured:.2f})"))
        rows.append(cells)
    head = ("scene", "particles", "blocks", *(f"{cores} cores" for cores in CORES[1:]))
    return lines + table(head, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repose", default=str(HERE.parent / "build/release/apps/repose/repose"))
    parser.add_argument("--bandwidth", type=float, default=400.0, help="of all cores together, GB/s (default 400)")
    parser.add_argument("--wake", type=float, default=1.0, help="us for the first doubling of threads (default 1)")
    parser.add_argument("--page", type=pathlib.Path)
    options = parser.parse_args()
    try:
        lines = forecast(options)
    except (measure.CannotMeasure, OSError) as error:
        print(f"forecast: could not measure: {error}", file=sys.stderr)
        return 2
    print("\n".join(lines))
    if options.page:
        put_between(options.page, BEGIN, END, lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
