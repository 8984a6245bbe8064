# Compares two builds of the command over scenes; see off_costs_nothing.sh.
#   off_costs_nothing.py FULL BARE NO_TIMER FOLDER_OF_SCENES
import json, os, re, statistics, subprocess, sys, tempfile

full, bare, no_timer, folder = sys.argv[1:5]
SCENES = [("hourglass", []), ("hourglass", ["--set", "grid.precision=double"]), ("shovel", [])]
MOST_INSTRUCTIONS = 1.001  # times those of the bare build
MOST_TIME = 1.03
STEPS = 200  # timed, and hashed
FEW, MORE = 4, 24  # counted steps; what setting up takes is in both and cancels
PAIRS = 9


def bench(program, scene, steps, options, before=()):
    """The figures of `repose bench`, and what the command `before` it wrote of it."""
    with tempfile.TemporaryDirectory() as out:
        figures = os.path.join(out, "bench.json")
        words = [*before, program, "bench", os.path.join(folder, scene + ".json"), "--threads", "1",
                 "--steps", str(steps), "--json", figures, *options]
        run = subprocess.run(words, capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(f"{' '.join(words)}: exit code {run.returncode}\n{run.stdout}{run.stderr}")
        return json.load(open(figures)), run.stderr


def instructions(program, scene, options):
    """Per step. Valgrind knows no AVX-512."""
    counted = []
    for steps in FEW, MORE:
        _, told = bench(program, scene, steps, [*options, "--target", "avx2"],
                        ["env", "LD_PRELOAD=" + no_timer, "valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"])
        counted.append(int(re.search(r"Collected\s*:\s*(\d+)", told).group(1)))
    return (counted[1] - counted[0]) / (MORE - FEW)


def time_ratio(scene, options):
    ratios = []
    for pair in range(PAIRS + 1):  # the first only warms up
        order = (full, bare) if pair % 2 else (bare, full)
        seconds = {program: bench(program, scene, STEPS, options)[0]["seconds"] for program in order}
        ratios.append(seconds[full] / seconds[bare])
    return statistics.median(ratios[1:])


failures = []
print("| scene | particles | state hash, full and bare | bytes per particle | instructions per step, bare |"
      " full / bare | time, full / bare |")
print("| --- | --- | --- | --- | --- | --- | --- |")
for scene, options in SCENES:
    name = " ".join([scene, *options[1:]])
    have, lack = (bench(program, scene, STEPS, options)[0] for program in (full, bare))
    if have["hash"] != lack["hash"]:
        failures.append(f"{name}: the state's hash is {have['hash']}, and {lack['hash']} without effects")
    if have["bytes_per_particle"] != lack["bytes_per_particle"]:
        failures.append(f"{name}: {have['bytes_per_particle']} bytes per particle, "
                        f"and {lack['bytes_per_particle']} without effects")
    count_full, count_bare = (instructions(program, scene, options) for program in (full, bare))
    count = count_full / count_bare
    if count > MOST_INSTRUCTIONS:
        failures.append(f"{name}: {count:.5f} times the instructions, at most {MOST_INSTRUCTIONS}")
    time = time_ratio(scene, options)
    print(f"| {name} | {have['particles']} | {have['hash']} {lack['hash']} | {have['bytes_per_particle']:.2f} "
          f"{lack['bytes_per_particle']:.2f} | {count_bare:.0f} | {count:.6f} | {time:.3f} |", flush=True)
    if time > MOST_TIME:
        print(f"{name}: {time:.3f} times the time, asked are {MOST_TIME}; a noisy machine, or a cost", flush=True)
for failure in failures:
    print(failure, file=sys.stderr)
sys.exit(1 if failures else 0)
