"""Whether anything takes more than it did. See regress.sh.
Exit codes: 0 as before, 1 worse, 2 could not measure."""
import argparse
import concurrent.futures
import os
import sys

import baselines
import cases
import measure
import paired
import report


def measure_all(program, quick, only, caches, no_timer, jobs):
    """`only`: names of cases, "output", "study NAME"; none: all."""
    wanted = [case for case in cases.CASES if (case.name in only if only else case.quick or not quick)]
    studies = [study for study in cases.STUDIES if not only or f"study {study.name}" in only]
    figures, where, lines = {}, {}, {}
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        made = {case.name: pool.submit(measure.of_case, program, case, no_timer, caches and not quick) for case in wanted}
        solves = {case.name: pool.submit(measure.of_solves, program, case) for case in wanted if "implicit" in case.name}
        runs = {"output": pool.submit(measure.of_output, program)} if not only or "output" in only else {}
        runs.update({f"study {study.name}": pool.submit(measure.of_study, program, study) for study in studies})
        for case in wanted:
            found, where[case.name], lines[case.name] = made[case.name].result()
            if case.name in solves:
                found.update(solves[case.name].result())
            figures.update({f"{case.name}: {name}": figure for name, figure in found.items()})
        for what, made_run in runs.items():
            figures.update({f"{what}: {name}": figure for name, figure in made_run.result().items()})
    return figures, where, lines


def gate(options):
    known = baselines.read(options.baselines)
    measured, where, lines = measure_all(options.program, options.quick, options.only, options.caches, options.no_timer, options.jobs)
    if options.quick or options.only or not options.caches:  # of what the whole gate knows, what was asked
        known = {name: figure for name, figure in known.items() if name in measured}
    if not known and not options.accept:
        print("regress: nothing has been accepted yet; --accept \"REASON\" makes what is measured the baseline", file=sys.stderr)
        return 2
    rows = baselines.compare(known, measured) + baselines.compare_functions(options.baselines, where)
    told = report.text(rows, where, lines, options.baselines)
    print(told)
    if options.report:
        os.makedirs(options.report, exist_ok=True)
        for name, content in (("report.txt", told), ("report.md", report.markdown(rows)),
                              ("index.html", report.page(rows, told, options.baselines))):
            with open(os.path.join(options.report, name), "w") as file:
                file.write(content)
    if options.accept:
        if options.quick:
            sys.exit("regress: the whole gate is accepted, or the cases of --only, not the quick part of them")
        baselines.accept(options.baselines, baselines.read(options.baselines), measured, where, options.accept,
                         bool(options.only) or not options.caches)
        return 0
    if not any(row[0] in ("worse", "gone", "new") for row in rows):
        return 0
    if options.tell_elsewhere and baselines.accepted_on(options.baselines) != baselines.processor():
        print(f"regress: accepted on another processor ({baselines.accepted_on(options.baselines)}): told, and not judged")
        return 0
    return 1


def ab(options):
    worse = False
    print("| case | median of HEAD / BASE | 95 % | verdict | wall time, HEAD / BASE, on 1 and on all threads | scaling, BASE and HEAD |")
    print("| --- | --- | --- | --- | --- | --- |")
    for case in cases.CASES:
        if not (case.name in options.only if options.only else case.quick):
            continue
        median, low, high = paired.ratio(options.base, options.head, case, options.pairs)
        slower = low > paired.WORSE
        worse = worse or slower
        base, head = paired.wall_times((options.base, options.head), case)
        walls, scaling = [h / b for h, b in zip(head, base)], [one / all_threads for one, all_threads in (base, head)]
        print(f"| {case.name} | {median:.4f} | {low:.4f} to {high:.4f} | {'slower' if slower else 'no slower'} "
              f"| {walls[0]:.2f}, {walls[1]:.2f} | {scaling[0]:.2f}, {scaling[1]:.2f} on {paired.THREADS} |", flush=True)
    return 1 if worse else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    of_gate = commands.add_parser("gate")
    of_gate.add_argument("program")
    of_gate.add_argument("--no-timer", required=True, help="a library, for valgrind")
    of_gate.add_argument("--baselines", required=True)
    of_gate.add_argument("--quick", action="store_true")
    only = {"default": [], "type": lambda names: names.split(","), "metavar": "CASE,..."}
    of_gate.add_argument("--only", **only, help="these cases; or output, or study NAME")
    of_gate.add_argument("--no-caches", dest="caches", action="store_false", help="all but misses, branches and peak memory")
    # Libraries choose their code by the processor.
    of_gate.add_argument("--tell-elsewhere", action="store_true",
                         help="on another processor than the baseline's, tell what is worse and end with 0")
    of_gate.add_argument("--accept", default="", metavar="REASON")
    of_gate.add_argument("--report", default="", metavar="FOLDER")
    of_gate.add_argument("--jobs", type=int, default=os.cpu_count())
    of_ab = commands.add_parser("ab")
    of_ab.add_argument("base")
    of_ab.add_argument("head")
    of_ab.add_argument("--only", **only, help="these cases")
    of_ab.add_argument("--pairs", type=int, default=25)
    options = parser.parse_args()
    try:
        return gate(options) if options.command == "gate" else ab(options)
    except measure.CannotMeasure as error:
        print(f"regress: could not measure: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
