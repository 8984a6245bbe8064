"""A copy of the sources with a build of its own, for programs that break the engine on purpose, a piece of text at a
time, to see whether it is noticed."""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PRESET = "release"


class Copy:
    """The sources and their build, apart from the checkout."""

    def __init__(self, folder, jobs):
        self.folder, self.jobs = folder, jobs
        self.build, self.logs = folder / "build" / PRESET, folder / "build/logs"

    def sync(self):
        """Makes the files those of the checkout; what is the same keeps its time."""
        listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], capture_output=True, text=True, check=True)
        wanted = {name for name in listed.stdout.split("\0") if name and (ROOT / name).is_file()}
        for name in wanted:
            here, there = ROOT / name, self.folder / name
            if there.is_file() and there.read_bytes() == here.read_bytes():
                continue
            there.parent.mkdir(parents=True, exist_ok=True)
            there.write_bytes(here.read_bytes())
            there.chmod(here.stat().st_mode)
        for there in self.folder.rglob("*"):
            name = there.relative_to(self.folder)
            if name.parts[0] != "build" and there.is_file() and str(name) not in wanted:
                there.unlink()
        self.logs.mkdir(parents=True, exist_ok=True)

    def call(self, log, *words):
        done = subprocess.run(words, cwd=self.folder, stdout=log, stderr=subprocess.STDOUT)
        return done.returncode == 0

    def configure(self, log):
        return self.call(log, "cmake", "--preset", PRESET, "-DREPOSE_TESTS=ON")

    def make(self, log, targets):
        return self.call(log, "cmake", "--build", self.build, "-j", str(self.jobs), "--target", *targets)

    def broken(self, broken):
        """While it lasts, the copy has that break in it."""
        return Broken(self.folder / broken.file, broken)


class Broken:
    def __init__(self, path, broken):
        self.path, self.broken = path, broken

    def __enter__(self):
        self.original = self.path.read_text()
        self.path.write_text(broken_text(self.broken, self.original))

    def __exit__(self, *_):
        self.path.write_text(self.original)


def broken_text(broken, text):
    """What a break looks for stands in its file once."""
    if text.count(broken.find) != 1:
        sys.exit(f"break {broken.name}: what it looks for stands {text.count(broken.find)} times, not once, in "
                 f"{broken.file}; that code has changed: change the list of breaks too")
    return text.replace(broken.find, broken.replace)
