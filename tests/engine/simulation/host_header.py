# What the header of hosts brings in: no library, and of Repose no more than it says.
#   host_header.py COMPILER SOURCE
import os, subprocess, sys

compiler, source = sys.argv[1:3]
HEADER, MOST = "engine/simulation/simulation.h", 15

run = subprocess.run([compiler, "-std=c++20", "-I", source, "-x", "c++", "-M", os.path.join(source, HEADER)],
                     capture_output=True, text=True)
if run.returncode != 0:
    sys.exit(run.stderr)
found = run.stdout.replace("\\\n", " ").split()[1:]
own = [os.path.relpath(path, source) for path in found if os.path.realpath(path).startswith(os.path.realpath(source))]
# What the compiler brings with it lies in its own folders, in bits/ and the like; libraries lie beside them.
standard = ("/usr/include/c++/", "/usr/lib/gcc/", "/usr/include/x86_64-linux-gnu/", "/usr/include/aarch64-linux-gnu/")
plain = {"/usr/include/" + name for name in os.listdir("/usr/include") if name.endswith(".h")}
plain |= {os.path.join(folder, name) for top in ("asm-generic", "linux", "bits") for folder, _, names in
          os.walk("/usr/include/" + top) for name in names}
LIBRARIES = ("eigen3", "Eigen", "tbb", "oneapi", "openvdb", "hwy", "json", "boost")
foreign = [path for path in found if os.path.relpath(path, source) not in own and
           (any("/" + library + "/" in path for library in LIBRARIES) or
            not (path.startswith(standard) or path in plain))]
print(f"{HEADER} brings in {len(own)} headers of Repose: {' '.join(own)}")
if foreign:
    sys.exit("and of libraries: " + " ".join(foreign))
if len(own) > MOST:
    sys.exit(f"more than {MOST}")
