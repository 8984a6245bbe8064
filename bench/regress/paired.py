"""Two programs at once, on one core: the ratio of the processor time of their steps, with an interval.

What a machine that others share does to a program changes from one second to the next. Two programs on one core take
turns every few milliseconds, so that whatever it does counts for both: of equal programs the ratios scatter by 1 %,
where runs one after the other scatter by 7."""
import contextlib
import json
import os
import random
import statistics
import subprocess
import tempfile

import measure

WORSE = 1.03
SCENE_STEPS = 900
THREADS = os.cpu_count()
WALL_TIMES = 5


def command(program, case, steps, threads=1):
    return [program, "bench", *measure.arguments(case, threads), "--steps", str(steps)]


def processor_times(commands, core):
    """Of each of them, s; all run at once, on one core."""
    seconds, failure = [], ""
    with contextlib.ExitStack() as files:
        running = []
        for words in commands:
            said = files.enter_context(tempfile.TemporaryFile("w+"))
            running.append((subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=said,
                                             preexec_fn=lambda: os.sched_setaffinity(0, {core})), said))
        for process, said in running:
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            seconds.append(used.ru_utime + used.ru_stime)
            if process.returncode != 0:
                said.seek(0)
                failure = f"{' '.join(process.args)}: exit code {process.returncode}\n{said.read()[-2000:]}"
    if failure:
        raise measure.CannotMeasure(failure)
    return seconds


def ratio(base, head, case, pairs, seed=1):
    """The median of head / base over pairs, either of them first, and its 95 % interval by the bootstrap. Each time is
    of steps alone: a run of few steps is taken from one of many."""
    core = max(os.sched_getaffinity(0))
    shuffle = random.Random(seed)
    ratios = []
    for pair in range(pairs + 1):  # the first only warms up
        both = [base, head] if pair % 2 else [head, base]
        few, many = (processor_times([command(program, case, steps) for program in both], core) for steps in (1, SCENE_STEPS))
        first, second = (max(m - f, 1e-9) for m, f in zip(many, few))
        if pair > 0:
            ratios.append(second / first if pair % 2 else first / second)
    medians = sorted(statistics.median(shuffle.choices(ratios, k=len(ratios))) for _ in range(2000))
    return statistics.median(ratios), medians[50], medians[1949]


def wall_times(programs, case):
    """Of each program, ns per particle and step on one thread and on all, medians of runs in turn: told, not judged."""
    found = {(program, threads): [] for program in programs for threads in (1, THREADS)}
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "bench.json")
        for _ in range(WALL_TIMES):
            for (program, threads), times in found.items():
                measure.run(command(program, case, SCENE_STEPS // 4, threads) + ["--json", path])
                with open(path) as file:
                    times.append(json.load(file)["ns_per_particle_step"])
    return [[statistics.median(found[program, threads]) for threads in (1, THREADS)] for program in programs]
