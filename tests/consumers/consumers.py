# Builds and runs what a user of the library would: outside the tree, against what `cmake --install` or a Debian
# package brings, or with the tree as a part of the project.
#   consumers.py PART --build DIR --source DIR --cmake CMAKE --command REPOSE
# Parts: shared, static, fetch, deb, python, pip, guide.
import argparse, glob, json, os, re, shutil, subprocess, sys, tempfile

parser = argparse.ArgumentParser()
parser.add_argument("part", choices=["shared", "static", "fetch", "deb", "python", "pip", "guide"])
for name in ("build", "source", "cmake", "command"):
    parser.add_argument(f"--{name}", required=True)
args = parser.parse_args()
EXAMPLES = os.path.join(args.source, "api", "examples")
SCENES = os.path.join(args.source, "apps", "scenes")
FRAMES = 2
PYTHON = "/usr/bin/python3"  # Debian's: the one that its packages of modules are for


def run(words, **more):
    done = subprocess.run(words, capture_output=True, text=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)} ended with {done.returncode}:\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def install(prefix):
    for component in ("runtime", "development"):
        run([args.cmake, "--install", args.build, "--prefix", prefix, "--component", component])


def configure_and_build(source, build, *more):
    run([args.cmake, "-S", source, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", *more])
    run([args.cmake, "--build", build, "-j", "2"])


def small_scene(folder):
    """A column of some thousand particles, as a file of its own."""
    path = os.path.join(folder, "column.json")
    with open(os.path.join(SCENES, "column.json")) as scene, open(path, "w") as small:
        small.write(scene.read().replace('"cells": 16', '"cells": 6'))
    return path


def hash_of_command(scene, folder):
    out = os.path.join(folder, "run")
    run([args.command, "run", scene, "--overwrite", "--out", out, "--frames", f"1-{FRAMES}"])
    with open(os.path.join(out, "run.json")) as log:
        return json.load(log)["frames"][-1]["hash"]


def hash_of(words, **more):
    return re.search(r"state hash ([0-9a-f]{16})", run(words, **more)).group(1)


def check_hashes(programs, folder, **more):
    scene = small_scene(folder)
    expected = hash_of_command(scene, folder)
    for program in programs:
        found = hash_of([program, scene, str(FRAMES)], **more)
        print(f"{os.path.basename(program)}: {found}, the command: {expected}")
        if found != expected:
            sys.exit("the hashes differ")


def check_errors(program, **more):
    done = subprocess.run([program, "no_such.json", "1"], capture_output=True, text=True, **more)
    if done.returncode != 66 or "no_such.json" not in done.stderr:
        sys.exit(f"a missing scene gave {done.returncode}: {done.stderr}")


def windy_scene(folder):
    """The column in a wind from a VDB file, the fog of a frame of its own."""
    scene, out = small_scene(folder), os.path.join(folder, "fog")
    run([args.command, "run", scene, "--overwrite", "--out", out, "--frames", "1-1", "--set", "output.fog={}"])
    shutil.copy(glob.glob(os.path.join(out, "*.fog.0001.vdb"))[0], os.path.join(folder, "wind.vdb"))
    path = os.path.join(folder, "windy.json")
    wind = '"force_fields": [{"name": "wind", "type": "wind_grid", "drag": 3, "file": "wind.vdb", "grid": "v"}],'
    with open(scene) as calm, open(path, "w") as windy:
        windy.write(calm.read().replace('"camera"', wind + ' "camera"'))
    return path


def check_grids(program, prefix, folder):
    """VDB files are read by the program that is installed, and by none where that is taken away."""
    scene = windy_scene(folder)
    out = os.path.join(folder, "windy")
    run([args.command, "run", scene, "--overwrite", "--out", out, "--frames", f"1-{FRAMES}"])
    with open(os.path.join(out, "run.json")) as log:
        expected = json.load(log)["frames"][-1]["hash"]
    found = hash_of([program, scene, str(FRAMES)])
    print(f"in a wind: {found}, the command: {expected}")
    if found != expected:
        sys.exit("the hashes differ")
    reader = os.path.join(prefix, "libexec", "repose", "repose-vdb-reader")
    os.rename(reader, reader + "-away")
    done = subprocess.run([program, scene, "1"], capture_output=True, text=True)
    os.rename(reader + "-away", reader)
    if done.returncode != 66 or reader not in done.stderr:
        sys.exit(f"without the reader of VDB files: {done.returncode}, {done.stderr}")


def shared(folder):
    prefix, build = os.path.join(folder, "prefix"), os.path.join(folder, "build")
    install(prefix)
    configure_and_build(EXAMPLES, build, f"-DCMAKE_PREFIX_PATH={prefix}")
    check_hashes([os.path.join(build, name) for name in ("frames", "bunny")], folder)
    check_errors(os.path.join(build, "frames"))
    check_grids(os.path.join(build, "frames"), prefix, folder)
    print(run([os.path.join(build, "host")]).strip())
    bunny = os.path.join(SCENES, "bunny.json")
    print(hash_of([os.path.join(build, "bunny"), bunny, "1"]), "after a frame of the bunny")
    # By pkg-config, with C alone, and nothing else in what the program needs.
    found = glob.glob(os.path.join(prefix, "lib*", "**", "pkgconfig"), recursive=True)
    flags = run(["pkg-config", "--cflags", "--libs", "repose"],
                env={**os.environ, "PKG_CONFIG_PATH": ":".join(found)}).split()
    program = os.path.join(folder, "by_pkg_config")
    run(["cc", "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", os.path.join(EXAMPLES, "frames.c"), *flags, "-o",
         program])
    libraries = os.path.dirname(found[0])
    check_hashes([program], folder, env={**os.environ, "LD_LIBRARY_PATH": libraries})
    needed = re.findall(r"NEEDED.*\[(.*)\]", run(["readelf", "-d", program]))
    if [name for name in needed if not name.startswith(("librepose.so.", "libc.so."))]:
        sys.exit(f"a C program needs more than the library: {needed}")


def static(folder):
    prefix, build = os.path.join(folder, "prefix"), os.path.join(folder, "build")
    install(prefix)
    configure_and_build(os.path.join(args.source, "tests", "consumers", "static"), build,
                        f"-DCMAKE_PREFIX_PATH={prefix}", f"-DEXAMPLES={EXAMPLES}")
    needed = run(["readelf", "-d", os.path.join(build, "frames")])
    if "librepose" in needed:
        sys.exit("the static program needs the shared library")
    check_hashes([os.path.join(build, name) for name in ("frames", "bunny")], folder)


def fetch(folder):
    build = os.path.join(folder, "build")
    configure_and_build(os.path.join(args.source, "tests", "consumers", "fetch"), build,
                        f"-DREPOSE_SOURCE={args.source}", f"-DEXAMPLES={EXAMPLES}")
    made = glob.glob(os.path.join(build, "**", "*_test"), recursive=True)
    if made or glob.glob(os.path.join(build, "**", "apps", "repose", "repose"), recursive=True):
        sys.exit("tests, or the command, were built within another project")
    check_hashes([os.path.join(build, name) for name in ("frames", "bunny")], folder)


def python(folder):
    prefix, build = os.path.join(folder, "prefix"), os.path.join(folder, "build")
    install(prefix)
    configure_and_build(os.path.join(args.source, "python"), build, f"-DCMAKE_PREFIX_PATH={prefix}",
                        f"-DCMAKE_INSTALL_PREFIX={prefix}", f"-DPYTHON_EXECUTABLE={PYTHON}")
    run([args.cmake, "--install", build])
    where = {**os.environ, "PYTHONPATH": os.path.join(prefix, "lib/python3/dist-packages"),
             "LD_LIBRARY_PATH": os.path.join(prefix, "lib")}
    check_module([PYTHON], folder, where)


def check_module(interpreter, folder, where):
    """`interpreter`, then a file of Python."""
    print(run([*interpreter, os.path.join(args.source, "tests", "consumers", "module_test.py")], env=where).strip())
    scene = small_scene(folder)
    expected = hash_of_command(scene, folder)
    found = hash_of([*interpreter, os.path.join(EXAMPLES, "frames.py"), scene, str(FRAMES)], env=where)
    print(f"frames.py: {found}, the command: {expected}")
    if found != expected:
        sys.exit("the hashes differ")


def pip(folder):
    """Built by pip, used by Python and, where it is installed, by the Python of Blender; and gone when uninstalled."""
    to = os.path.join(folder, "modules")
    source = os.path.join(folder, "source")
    shutil.copytree(args.source, source, ignore=shutil.ignore_patterns("build", "out", ".git", "*.egg-info"))
    run([PYTHON, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index", "--target", to, source])
    where = {**os.environ, "PYTHONPATH": to}
    check_module([PYTHON], folder, where)
    blender = shutil.which("blender")
    if not blender:
        print("there is no Blender: not tried in its Python")
        return
    script = os.path.join(folder, "in_blender.py")
    with open(script, "w") as file:
        file.write("import sys\n" f"sys.path.insert(0, {to!r})\n"
                   "sys.argv = sys.argv[sys.argv.index('--'):]\n"
                   f"exec(compile(open({os.path.join(EXAMPLES, 'frames.py')!r}).read(), 'frames.py', 'exec'))\n")
    scene = small_scene(folder)
    found = hash_of([blender, "--background", "--factory-startup", "--python-exit-code", "1", "--python", script, "--",
                     scene, str(FRAMES)], env={**os.environ, "PATH": "/usr/bin:/bin"})  # where Debian's Python is found first
    expected = hash_of_command(scene, folder)
    print(f"in Blender: {found}, the command: {expected}")
    if found != expected:
        sys.exit("the hashes differ")


def deb(folder):
    with_module = [args.cmake, "-S", args.source, "-B", args.build]
    run([*with_module, "-DREPOSE_PYTHON=ON", f"-DPYTHON_EXECUTABLE={PYTHON}"])
    try:
        run([args.cmake, "--build", args.build, "-j", "2"])
        run(["cpack", "-B", folder], cwd=args.build)
    finally:
        run([*with_module, "-DREPOSE_PYTHON=OFF"])
    packages = sorted(glob.glob(os.path.join(folder, "*.deb")))
    names = [run(["dpkg-deb", "-f", package, "Package"]).strip() for package in packages]
    print(", ".join(os.path.basename(package) for package in packages))
    if not {"librepose0", "librepose-dev", "repose", "python3-repose"} <= set(names):
        sys.exit(f"packages are missing: {names}")
    depends = run(["dpkg-deb", "-f", packages[names.index("librepose0")], "Depends"])
    if "libopenvdb" not in depends or "libtbb" not in depends:
        sys.exit(f"librepose0 depends on {depends}")
    # Into a root of its own, and out again.
    root = os.path.join(folder, "root")
    for made in ("var/lib/dpkg/info", "var/lib/dpkg/updates", "usr"):
        os.makedirs(os.path.join(root, made))
    open(os.path.join(root, "var/lib/dpkg/status"), "w").close()
    dpkg = ["dpkg", f"--root={root}", "--force-depends", "--force-not-root", "--force-script-chrootless",
            f"--log={folder}/dpkg.log"]
    run(dpkg + ["-i", *packages])
    files = [os.path.join(at, name) for at, _, all_names in os.walk(os.path.join(root, "usr")) for name in all_names]
    wanted = ("librepose.so.0", "repose.h", "repose.hpp", "repose-config.cmake", "repose.pc", "bin/repose",
              "libexec/repose/repose-vdb-reader")
    for one in wanted:
        if not [file for file in files if file.endswith(one)]:
            sys.exit(f"{one} is not installed")
    build = os.path.join(folder, "build")
    configure_and_build(EXAMPLES, build, f"-DCMAKE_PREFIX_PATH={root}/usr")
    check_hashes([os.path.join(build, "frames")], folder)
    check_module([PYTHON], folder, {**os.environ, "PYTHONPATH": os.path.join(root, "usr/lib/python3/dist-packages"),
                                    "LD_LIBRARY_PATH": os.path.join(root, "usr/lib")})
    run(dpkg + ["-P", *names])
    left = [os.path.join(at, name) for at, _, all_names in os.walk(os.path.join(root, "usr")) for name in all_names]
    if left:
        sys.exit(f"left behind: {left[:5]}")
    if shutil.which("lintian"):
        # Whoever publishes packages names a maintainer.
        done = subprocess.run(["lintian", "--fail-on", "error", "--suppress-tags",
                               "bogus-mail-host,bogus-mail-host-in-debian-changelog", *packages],
                              capture_output=True, text=True)
        print(done.stdout)
        if done.returncode != 0:
            sys.exit("lintian finds errors")


def guide(folder):
    """Each block of the guide that begins with a file's name is that file, and each example stands in it."""
    with open(os.path.join(args.source, "docs", "embedding.md")) as file:
        text = file.read()
    shown = dict(re.findall(r"`api/examples/([\w.]+)`:\n\n```\w*\n(.*?)```", text, re.DOTALL))
    for name in sorted(os.listdir(EXAMPLES)):
        with open(os.path.join(EXAMPLES, name)) as file:
            if shown.get(name) != file.read():
                sys.exit(f"docs/embedding.md does not show api/examples/{name} as it is")
    declared = set()
    for header in glob.glob(os.path.join(args.source, "api", "include", "repose", "*.h")):
        with open(header) as file:
            declared |= set(re.findall(r"\brepose_\w+", file.read()))
    declared |= {name + "_init" for name in declared} | {"repose_static"}
    unknown = set(re.findall(r"\brepose_\w+", text)) - declared
    if unknown:
        sys.exit(f"docs/embedding.md names what there is not: {sorted(unknown)}")
    print(f"{len(shown)} examples")


with tempfile.TemporaryDirectory(prefix="repose-consumers-") as temporary:
    globals()[args.part](temporary)
