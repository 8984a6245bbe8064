#!/usr/bin/env python3
"""The binary interface of the public headers is the one that was accepted last.

  abi.py              compares; ends with 1 and says what has changed
  abi.py --accept     accepts what there is: writes tests/api/abi anew, to be committed with the change

Two records stand in tests/api/abi. layout.txt: size and offset of every member of every public struct, and the value of
every enumerator, as the C compiler has them. repose.abi: functions with the types of their arguments, as abidw (Debian's
abigail-tools) reads them from debug information, compared by abidiff where it is installed. That information is of a
library made of the headers alone, with a body of nothing for each function: the same in every build, and there in those
without symbols. That the real library shows these functions and no others is symbols.sh's to say.
"""
import argparse, difflib, glob, os, re, shutil, subprocess, sys, tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
parser = argparse.ArgumentParser()
parser.add_argument("--headers", default=os.path.join(HERE, "..", "..", "api", "include", "repose"))
parser.add_argument("--accepted", default=os.path.join(HERE, "abi"))
parser.add_argument("--accept", action="store_true")
args = parser.parse_args()
LAYOUT, DUMP = (os.path.join(args.accepted, name) for name in ("layout.txt", "repose.abi"))


def run(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def header_text():
    text = ""
    for name in sorted(glob.glob(os.path.join(args.headers, "*.h"))):
        with open(name) as file:
            text += file.read()
    return re.sub(r"\s+", " ", re.sub(r"/\*.*?\*/", " ", re.sub(r"^\s*#.*(\\\n.*)*$", "", text, flags=re.M), flags=re.S))


def layout_program(text):
    """Prints a line for each struct, member and enumerator."""
    lines = ['#include <stdio.h>', '#include "repose.h"', "int main(void) {"]
    for struct, body in re.findall(r"typedef struct (\w+) \{(.*?)\}", text):
        lines.append(f'  printf("{struct}: %zu bytes\\n", sizeof({struct}));')
        for declaration in filter(None, (part.strip() for part in body.split(";"))):
            first, *others = declaration.split(",")
            members = [re.sub(r"\[.*", "", first).split()[-1].lstrip("*"), *(re.sub(r"[\s*]|\[.*", "", o) for o in others)]
            for member in members:
                lines.append(f'  printf("{struct}.{member}: %zu bytes at %zu\\n", sizeof((({struct}*)0)->{member}), '
                             f"offsetof({struct}, {member}));")
    for body in re.findall(r"\benum \{(.*?)\}", text):
        for enumerator in re.findall(r"\b(REPOSE_\w+) =", body):
            lines.append(f'  printf("{enumerator} = %d\\n", (int){enumerator});')
    return "\n".join(lines + ["  return 0;", "}", ""])


def stub_library(text):
    lines = ['#include "repose.h"']
    for returned, function, arguments in re.findall(r"REPOSE_API ([\w ]+?[ *]+)(repose_\w+)\((.*?)\);", text):
        lines.append(f"{returned} {function}({arguments}) {{ return 0; }}")
    return "\n".join(lines + [""])


def compiled(folder, name, source, *flags):
    made = os.path.join(folder, name)
    with open(made + ".c", "w") as file:
        file.write(source)
    run(["cc", "-std=c99", "-I", args.headers, *flags, made + ".c", "-o", made])
    return made


with tempfile.TemporaryDirectory(prefix="repose-abi-") as temporary:
    header = header_text()
    layout = run([compiled(temporary, "layout", layout_program(header))])
    library = compiled(temporary, "librepose.so", stub_library(header), "-g", "-O0", "-shared", "-fPIC",
                       "-Wl,-soname,librepose.so")
    print(len(re.findall(r"^repose_\w+: ", layout, re.M)), "structs,", header.count("REPOSE_API "), "functions")
    if args.accept:
        os.makedirs(args.accepted, exist_ok=True)
        with open(LAYOUT, "w") as file:
            file.write(layout)
        if not shutil.which("abidw"):
            sys.exit("abidw is missing (Debian's abigail-tools): repose.abi is as it was")
        run(["abidw", "--no-comp-dir-path", "--no-corpus-path", "--no-show-locs", "--out-file", DUMP, library])
        sys.exit(0)
    with open(LAYOUT) as file:
        accepted = file.read()
    changes = list(difflib.unified_diff(accepted.splitlines(), layout.splitlines(), "accepted", "now", lineterm="", n=0))
    if shutil.which("abidiff"):
        done = subprocess.run(["abidiff", "--no-show-locs", DUMP, library], capture_output=True, text=True)
        if done.returncode != 0:
            changes += [f"abidiff ends with {done.returncode}:", done.stdout + done.stderr]
    else:
        print("without abidiff (Debian's abigail-tools) layouts alone are compared")
    if changes:
        print("\n".join(changes))
        sys.exit("the binary interface has changed; where that is meant: python3 tests/api/abi.py --accept")
