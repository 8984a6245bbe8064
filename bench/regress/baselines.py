"""What the figures were when somebody last accepted them, one line each, and how far each may stray from that."""
import collections
import datetime
import os
import statistics
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tests"))
from processor import processor

PROCESSOR = "processor.txt"
HISTORY = 20
LEAST, MOST = 0.002, 0.01  # shares of a count
FUNCTION, NOTABLE = 0.01, 0.003  # how far a function's instructions may go, if it has this share of a step's
KEPT = 0.001  # functions of a smaller share are not written down
OTHER = {"misses": (0.01, 0.05), "memory": (0.02, 0.05), "error": (0.02, 0.05), "value": (0.01, 0.02)}

Figure = collections.namedtuple("Figure", "kind value changes")


def accepted_on(folder):
    with open(os.path.join(folder, PROCESSOR)) as text:
        return text.read().strip()


def text_of(value):
    return value if isinstance(value, str) else repr(value)


def read(folder):
    """{"case: figure": Figure}; empty where there is none yet."""
    path = os.path.join(folder, "figures.txt")
    known = {}
    if os.path.exists(path):
        with open(path) as text:
            for row in text:
                name, kind, value, changes = row.rstrip("\n").split("\t")
                known[name] = Figure(kind, value, [float(word) for word in changes.split()])
    return known


def allowed(figure):
    """How far a figure may go from its baseline, as a share: beyond the third quartile of the changes that were
    accepted by three times the distance of the quartiles."""
    if figure.kind == "exact":
        return 0.0
    least, most = OTHER.get(figure.kind, (LEAST, MOST))
    if len(figure.changes) < 4:
        return least
    low, _, high = statistics.quantiles(figure.changes, n=4)
    return min(most, max(least, high + 3.0 * (high - low)))


def change(old, new):
    old, new = float(old), float(new)
    return 0.0 if old == new else (new - old) / old if old else float("inf")


def compare(known, measured):
    """Rows (verdict, name, old, new, change, allowed): "worse", "better", "new", "gone", or "as before"."""
    rows = []
    for name in sorted(known.keys() | measured.keys()):
        if name not in measured:
            rows.append(("gone", name, known[name].value, "", 0.0, 0.0))
            continue
        kind, value = measured[name]
        if name not in known:
            rows.append(("new", name, "", text_of(value), 0.0, 0.0))
            continue
        old, limit = known[name], allowed(known[name])
        if kind == "exact":
            same = old.value == text_of(value)
            rows.append(("as before" if same else "worse", name, old.value, text_of(value), 0.0, 0.0))
            continue
        by = change(old.value, value)
        away = abs(by) if kind == "value" else by
        verdict = "worse" if away > limit else "better" if away < -limit else "as before"
        rows.append((verdict, name, old.value, text_of(value), by, limit))
    return rows


def compare_functions(folder, where):
    """Rows as compare() has them, of functions that take much of a step: a kernel that grows must not hide in the whole.
    What has another name now is in the whole alone."""
    rows = []
    for case in sorted(where):
        known, total = read_functions(folder, case), sum(where[case].values())
        for name in sorted(known.keys() & where[case].keys()):
            old, new = known[name], where[case][name]
            # How often threads look for work is a matter of time.
            if max(old, new) < NOTABLE * total or "tbb" in name:
                continue
            by = change(old, new)
            verdict = "worse" if by > FUNCTION else "better" if by < -FUNCTION else "as before"
            rows.append((verdict, f"{case}: instructions of {name}", f"{old:.0f}", f"{new:.0f}", by, FUNCTION))
    return rows


def accept(folder, known, measured, where, reason, keep=False):
    """Takes what was measured as the baseline, and writes into the log why, and what differs. `keep`: what was not
    measured stays as it is known."""
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, PROCESSOR), "w") as text:
        text.write(processor() + "\n")
    if keep:
        measured = {**{name: (figure.kind, figure.value) for name, figure in known.items()}, **measured}
    rows = [row for row in compare(known, measured) if row[0] != "as before"]
    with open(os.path.join(folder, "log.md"), "a") as log:
        log.write(f"## {datetime.date.today().isoformat()}: {reason}\n\n")
        for verdict, name, old, new, by, _ in rows:
            log.write(f"- {name}: {old or 'none'} -> {new or 'none'}" + (f" ({100 * by:+.2f} %)" if by else "") + "\n")
        log.write("\n" if rows else "No figure differs.\n\n")
    with open(os.path.join(folder, "history.txt"), "a") as history:
        for verdict, name, _, new, _, _ in rows:
            history.write(f"{datetime.date.today().isoformat()}\t{name}\t{new}\n")
    with open(os.path.join(folder, "figures.txt"), "w") as text:
        for name in sorted(measured):
            kind, value = measured[name]
            changes = list(known[name].changes) if name in known else []
            if name in known and kind != "exact":
                changes.append(round(abs(change(known[name].value, value)), 6))
            text.write("\t".join([name, kind, text_of(value), " ".join(map(repr, changes[-HISTORY:]))]) + "\n")
    os.makedirs(os.path.join(folder, "functions"), exist_ok=True)
    for case, functions in where.items():
        with open(os.path.join(folder, "functions", case.replace(" ", "_") + ".txt"), "w") as text:
            least = KEPT * sum(functions.values())
            for function, count in sorted(functions.items(), key=lambda item: -item[1]):
                if count >= least:
                    text.write(f"{count:.0f}\t{function}\n")


def read_functions(folder, case):
    path = os.path.join(folder, "functions", case.replace(" ", "_") + ".txt")
    if not os.path.exists(path):
        return {}
    with open(path) as text:
        return {function: float(count) for count, function in (row.rstrip("\n").split("\t", 1) for row in text)}


def read_history(folder):
    """{name: [(date, value)]} of accepted values, each where it changed."""
    path = os.path.join(folder, "history.txt")
    history = collections.defaultdict(list)
    if os.path.exists(path):
        with open(path) as text:
            for row in text:
                date, name, value = row.rstrip("\n").split("\t")
                history[name].append((date, value))
    return history
