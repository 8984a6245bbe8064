"""Figures of a program: what repeats exactly, or nearly so, whatever else the machine does."""
import collections
import json
import os
import re
import subprocess
import tempfile

import cases

HERE = os.path.dirname(os.path.abspath(__file__))
SCENE = os.path.join(HERE, "column.json")
# A geometry of caches that is nobody's, so that it is everybody's.
FEW = 100  # allocations of a step that are counted to the last one: of a solve's some are those of threads
CACHES = ["--cache-sim=yes", "--I1=32768,8,64", "--D1=32768,8,64", "--LL=8388608,16,64", "--branch-sim=yes"]


class CannotMeasure(Exception):
    pass


def run(words, **more):
    done = subprocess.run(words, capture_output=True, text=True, **more)
    if done.returncode != 0:
        raise CannotMeasure(f"{' '.join(words)}: exit code {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done


def arguments(case, threads=1):
    words = [SCENE, "--threads", str(threads), "--target", "avx2"]
    for override in case.overrides:
        words += ["--set", override]
    return words


def bench(program, case, steps, before=()):
    """The figures of `repose bench`."""
    with tempfile.TemporaryDirectory() as out:
        file = os.path.join(out, "bench.json")
        run([*before, program, "bench", *arguments(case), "--steps", str(steps), "--json", file])
        with open(file) as text:
            return json.load(text)


def short_name(function):
    """Names of templates can be longer than a page; what they begin with tells them apart."""
    return re.sub(r"\(anonymous namespace\)::|repose::", "", function)[:120]


def read_callgrind(path):
    """Events by name, of each function, and of each line of each function where the program knows its lines."""
    events, functions, lines = [], collections.defaultdict(collections.Counter), collections.defaultdict(collections.Counter)
    names = {"fn": {}, "fl": {}}
    function = file = ""
    line, skip = 0, False

    def named(kind, text):
        found = re.match(r"\((\d+)\)(?: (.*))?", text)
        if found.group(2) is not None:
            names[kind][found.group(1)] = short_name(found.group(2)) if kind == "fn" else found.group(2)
        return names[kind].get(found.group(1), "?")

    with open(path) as text:
        for row in text:
            row = row.rstrip("\n")
            if row.startswith("events:"):
                events = row.split()[1:]
            elif row.startswith("fn="):
                function = named("fn", row[3:])
            elif row[:3] in ("fl=", "fi=", "fe="):
                file = named("fl", row[3:])
            elif row.startswith("cfn="):
                named("fn", row[4:])
            elif row[:4] in ("cfi=", "cfl="):
                named("fl", row[4:])
            elif row.startswith("calls="):
                skip = True  # the next row is what was called, which counts for itself
            elif row and (row[0].isdigit() or row[0] in "+-*"):
                words = row.split()
                at = words[0]
                line = line if at == "*" else line + int(at) if at[0] in "+-" else int(at)
                if skip:
                    skip = False
                    continue
                for event, count in zip(events, words[1:]):
                    functions[function][event] += int(count)
                    lines[f"{file}:{line} in {function}"][event] += int(count)
    return functions, lines


def counted(program, case, steps, no_timer, caches):
    with tempfile.TemporaryDirectory() as out:
        file = os.path.join(out, "callgrind")
        run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={file}", "--compress-strings=yes",
             *(CACHES if caches else []), program, "bench", *arguments(case), "--steps", str(steps)],
            env={**os.environ, "LD_PRELOAD": no_timer})
        return read_callgrind(file)


def per_step(more, few, steps):
    rest = {}
    for name in more:
        difference = {event: (count - few.get(name, {}).get(event, 0)) / steps for event, count in more[name].items()}
        if any(abs(value) >= 1 for value in difference.values()):
            rest[name] = difference
    return rest


def of_steps(program, case, no_timer, caches):
    """Events per step, of functions and of lines."""
    few, few_lines = counted(program, case, case.few, no_timer, caches)
    more, more_lines = counted(program, case, case.more, no_timer, caches)
    steps = case.more - case.few
    return per_step(more, few, steps), per_step(more_lines, few_lines, steps)


def allocations(program, case, steps, no_timer):
    """Of a whole run; memcheck counts them."""
    told = run(["valgrind", "--tool=memcheck", "--leak-check=no", "--undef-value-errors=no", program, "bench",
                *arguments(case), "--steps", str(steps)], env={**os.environ, "LD_PRELOAD": no_timer}).stderr
    return int(re.search(r"total heap usage: ([\d,]+) allocs", told).group(1).replace(",", ""))


def of_case(program, case, no_timer, caches):
    """Figures as {name: (kind, value)}, and where the instructions of a step are."""
    figures = {}
    have = bench(program, case, case.more)
    figures["hash after %d steps" % case.more] = ("exact", have["hash"])
    for name, key in (("bytes per particle", "bytes_per_particle"), ("grid bytes per block", "grid_bytes_per_block"),
                      ("blocks", "blocks"), ("sorts", "sorts")):
        figures[name] = ("exact", round(have[key], 6))
    figures["time reached, s"] = ("exact", have["time"])
    if caches:  # of the whole gate alone, too: how much of a library lies in memory is the machine's affair
        figures["peak memory, bytes"] = ("memory", have["peak_rss_bytes"])
    if case.quick:
        count = [allocations(program, case, steps, no_timer) for steps in (case.few, case.more)]
        per_step_made = round((count[1] - count[0]) / (case.more - case.few))  # one or two of a run are its report's
        figures["heap allocations per step"] = ("exact" if per_step_made < FEW else "count", per_step_made)
    # Counted without caches in either gate: the simulator changes counts by some per mille.
    where, lines = of_steps(program, case, no_timer, False)
    figures["instructions per step"] = ("count", sum(events["Ir"] for events in where.values()))
    if caches:
        total = collections.Counter()
        for events in of_steps(program, case, no_timer, True)[0].values():
            total.update(events)
        figures["branches per step"] = ("count", total["Bc"])
        figures["first-level misses per step"] = ("misses", total["D1mr"] + total["D1mw"])
        figures["last-level misses per step"] = ("misses", total["DLmr"] + total["DLmw"])
    return figures, {name: events["Ir"] for name, events in where.items()}, {n: e["Ir"] for n, e in lines.items()}


def of_output(program):
    """Of a whole run: what it writes, and how its steps were made."""
    with tempfile.TemporaryDirectory() as out:
        folder = os.path.join(out, "run")
        run([program, "run", *arguments(cases.OUTPUT), "--out", folder, "--quiet"])
        figures = {}
        for name in sorted(os.listdir(folder)):
            if re.search(r"\.(vdb|checkpoint)$", name):
                figures[f"bytes of {name}"] = ("memory", os.path.getsize(os.path.join(folder, name)))
        with open(os.path.join(folder, "run.json")) as text:
            frames = json.load(text)["frames"]
        figures["steps"] = ("exact", sum(frame["steps"] for frame in frames))
        return figures


def of_solves(program, case):
    """Iterations of implicit steps."""
    with tempfile.TemporaryDirectory() as out:
        folder = os.path.join(out, "run")
        run([program, "run", *arguments(case), "--out", folder, "--quiet"])
        with open(os.path.join(folder, "run.json")) as text:
            frames = json.load(text)["frames"]
        return {f"{what} of a frame": ("exact", sum(frame[key] for frame in frames))
                for what, key in (("Newton iterations", "newton_iterations"), ("linear iterations", "solver_iterations"))}


def of_study(program, study):
    """Figures of merit: whether what it computes is still as near to the truth."""
    with tempfile.TemporaryDirectory() as out:
        file = os.path.join(out, "figures.json")
        scene = os.path.join(HERE, "..", "studies", study.name + ".json")
        run([program, "figures", scene, "--threads", "1", "--target", "avx2", "--json", file,
             *(word for override in study.overrides for word in ("--set", override))])
        with open(file) as text:
            found = json.load(text)["figures"]
        return {name: (kind, found[name]["value"]) for name, kind in study.kinds.items()}
