"""Which lines of the sources are other than when the baseline was accepted."""
import collections
import os
import re
import subprocess

OF_STEPS = ("kernels", "engine", "cmake", "CMakeLists.txt", "CMakePresets.json")


def git(root, *words):
    done = subprocess.run(["git", "-C", root, *words], capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else ""


def of_difference(text):
    """{path: lines of the new file} of a difference without context."""
    changed, path = collections.defaultdict(set), ""
    for row in text.splitlines():
        if row.startswith("+++ "):
            path = row[6:] if row.startswith("+++ b/") else ""
        hunk = re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", row)
        if hunk and path:
            first, count = int(hunk.group(1)), int(hunk.group(2) or 1)
            changed[path].update(range(first, first + max(count, 1)))  # what was taken out is told by where it was
    return changed


def changed_since_accepted(baselines):
    """Empty where there is no history to ask."""
    folder = os.path.abspath(baselines)
    root = git(folder, "rev-parse", "--show-toplevel").strip()
    accepted = git(folder, "log", "-1", "--format=%H", "--", folder).strip()
    if not accepted:
        return {}
    return of_difference(git(root, "diff", "-U0", accepted, "--", *OF_STEPS))


def is_changed(place, changed):
    """`place`: "path:line" as a program's debug information has it, relative to any folder."""
    path, _, line = place.rpartition(":")
    path = re.sub(r"^(\.\./)+", "", path)
    return any(int(line) in lines and (path == of or path.endswith("/" + of)) for of, lines in changed.items())


def spans(lines):
    """"3, 7 to 9" of a set of numbers."""
    told, ordered = [], sorted(lines)
    while ordered:
        first = last = ordered.pop(0)
        while ordered and ordered[0] == last + 1:
            last = ordered.pop(0)
        told.append(str(first) if first == last else f"{first} to {last}")
    return ", ".join(told)
