"""A run of a hundred thousand steps with all that it can write: memory and descriptors stay what they are.

soak.py PROGRAM

A drum turns sand, and over it a sink takes what a spout gives: particles begin, end and change blocks all the time. Each
frame writes points, a surface and a state. After two fifths of the run, resident memory may grow by 1 %, descriptors by
none. (The log keeps some 10 kB of each frame, so there are few of these.)"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

FRAMES, STEPS = 20, 100000
RATE = 25  # frames per second
MOST_GROWTH = 0.01
TRIES = 4
SCENE = {
    "repose": 1, "name": "soak", "grid": {"spacing": 0.01, "plane_strain": "z"},
    "time": {"frames_per_second": RATE, "frames": FRAMES, "max_step": FRAMES / RATE / STEPS},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "sand", "material": "sand", "particles_per_cell": 4,
                "shape": {"type": "box", "lower": [-0.03, -0.05, -1], "upper": [0.03, -0.03, 1]}}],
    "emitters": [{"name": "spout", "material": "sand", "type": "rectangle", "center": [0, 0.03, 0], "normal": [0, -1, 0],
                  "direction": [1, 0, 0], "half_width": 0.015, "half_depth": 1, "speed": 0.15, "particles_per_cell": 4}],
    "sinks": [{"name": "drain", "shape": {"type": "box", "lower": [-0.06, -0.02, -9], "upper": [0.06, 0, 9]}}],
    "probes": [{"name": "all", "type": "energy"}],
    "colliders": [{"name": "drum", "hollow": True, "friction": 0.8,
                   "shape": {"type": "cylinder", "center": [0, 0, -1], "axis": [0, 0, 1], "radius": 0.06, "height": 2},
                   "motion": {"repeat": True, "keys": [{"time": 0}, {"time": 1, "rotation_axis": [0, 0, 1],
                                                                     "rotation_angle": 360}]}}],
    "output": {"vdb": True, "ply": True, "surface": {}, "checkpoint": True},
}


def looks(process, out):
    """(frames that are done, resident memory in kB, descriptors), until it ends."""
    seen = []
    while process.poll() is None:
        try:
            resident = int(pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGESIZE") // 1024
            seen.append((len(list(out.glob("soak.*.ply"))), resident, len(os.listdir(f"/proc/{process.pid}/fd"))))
        except (OSError, IndexError):  # it has ended
            break
        time.sleep(0.01)
    return seen


def grows():
    """Whether a run takes more at its end than soon after its start."""
    with tempfile.TemporaryDirectory() as folder:
        scene, out = pathlib.Path(folder, "soak.json"), pathlib.Path(folder, "out")
        scene.write_text(json.dumps(SCENE))
        process = subprocess.Popen([sys.argv[1], "run", scene, "--out", out, "--threads", "2", "--quiet"])
        seen = looks(process, out)
        if process.wait() != 0:
            sys.exit(f"exit code {process.returncode}")
        frames = json.loads((out / "run.json").read_text())["frames"]
        steps, written = sum(frame["steps"] for frame in frames), len(list(out.glob("soak.*.ply")))
    if steps < STEPS or written != FRAMES:
        sys.exit(f"{steps} steps, {written} frames: fewer than were asked for")
    warm = [look for look in seen if FRAMES // 5 <= look[0] < 2 * FRAMES // 5]
    rest = [look for look in seen if 2 * FRAMES // 5 <= look[0] < FRAMES]
    if len(warm) < 5 or len(rest) < 30:
        sys.exit(f"looked {len(warm)} and {len(rest)} times: too seldom")
    # Files that are being written come and go, with what they need.
    (memory, open_files), (memory_then, open_then) = ([min(look[k] for look in looks) for k in (1, 2)]
                                                      for looks in (warm, rest[-len(rest) // 2:]))
    growth, more = memory_then / memory - 1.0, open_then - open_files
    print(f"{frames[2 * FRAMES // 5]['particles']} and {frames[-1]['particles']} particles")
    print(f"{steps} steps, {len(frames)} frames: memory {memory:g} kB, {100 * growth:+.2f} %; descriptors {more:+g}")
    return growth > MOST_GROWTH or more > 0


def main():
    # When an allocator gives pages back differs from run to run, by 1 % one time in seven; what piles up does so each time.
    if all(grows() for _ in range(TRIES)):
        sys.exit("something piles up")


if __name__ == "__main__":
    main()
