"""Two programs, in turn: the ratio of the processor time of their steps, with an interval."""
import random
import resource
import statistics
import subprocess

import measure

WORSE = 1.03
SCENE_STEPS = 450
TURNS = 4  # of each program within a pair: a machine that others share changes from one second to the next


def processor_time(words):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(words, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise measure.CannotMeasure(f"{' '.join(words)}: exit code {done.returncode}\n{done.stderr[-2000:]}")
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def ratio(base, head, case, pairs, seed=1):
    """The median of head / base over pairs in shuffled order, and its 95 % interval by the bootstrap. Each time is of
    steps alone: a run of few steps is taken from one of many."""
    shuffle = random.Random(seed)

    def steps_of(program):
        few, many = (processor_time([program, "bench", *measure.arguments(case), "--steps", str(steps)])
                     for steps in (1, SCENE_STEPS))
        return max(many - few, 1e-9)

    ratios = []
    programs = (base, head)
    for pair in range(pairs + 1):  # the first only warms up
        seconds = [0.0, 0.0]
        for _ in range(TURNS if pair > 0 else 1):
            for which in shuffle.sample((0, 1), 2):
                seconds[which] += steps_of(programs[which])
        if pair > 0:
            ratios.append(seconds[1] / seconds[0])
    medians = sorted(statistics.median(shuffle.choices(ratios, k=len(ratios))) for _ in range(2000))
    return statistics.median(ratios), medians[50], medians[1949]
