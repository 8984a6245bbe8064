# What the header of hosts brings in: no library, and of Repose no more than it says.
#   host_header.py COMPILER SOURCE
import os, subprocess, sys

compiler, source = sys.argv[1], os.path.realpath(sys.argv[2])
HEADER, MOST = "engine/simulation/simulation.h", 16

# -MM leaves out what stands in <>: so do all libraries, and so does the standard library. Which of the two is told
# by the libraries' own folders.
LIBRARIES = ("/Eigen/", "/eigen3/", "/tbb/", "/oneapi/", "/openvdb/", "/hwy/", "/json/", "/boost/")


def included(flag):
    run = subprocess.run([compiler, "-std=c++20", "-I", source, "-isystem", "/usr/include/eigen3", "-x", "c++", flag,
                          os.path.join(source, HEADER)], capture_output=True, text=True)
    if run.returncode != 0:
        sys.exit(run.stderr)
    return run.stdout.replace("\\\n", " ").split()[1:]


own = [os.path.relpath(path, source) for path in included("-MM")]
print(f"{HEADER} brings in {len(own)} headers of Repose: {' '.join(own)}")
foreign = [path for path in included("-M") if any(library in path for library in LIBRARIES)]
if foreign:
    sys.exit("and of libraries: " + " ".join(foreign[:5]))
if len(own) > MOST:
    sys.exit(f"more than {MOST}")
