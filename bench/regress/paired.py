"""Two programs, in turn: the ratio of the processor time of their steps, with an interval."""
import random
import resource
import statistics
import subprocess

import measure

WORSE = 1.03
SCENE_STEPS = 150


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
        order = [0, 1]
        shuffle.shuffle(order)
        seconds = {which: steps_of(programs[which]) for which in order}
        if pair > 0:
            ratios.append(seconds[1] / seconds[0])
    medians = sorted(statistics.median(shuffle.choices(ratios, k=len(ratios))) for _ in range(2000))
    return statistics.median(ratios), medians[50], medians[1949]
