"""The module for Python as a wheel. CMake builds it, and the engine, which goes beside it: repose.libs."""
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


def cmake(*words):
    subprocess.run(["cmake", *map(str, words)], check=True)


class BuildWithCMake(build_ext):
    def run(self):
        made = pathlib.Path(self.build_temp).resolve()
        to = pathlib.Path(self.get_ext_fullpath("repose")).resolve().parent
        release = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"]
        cmake("-S", ROOT, "-B", made / "engine", *release, "-DREPOSE_TESTS=OFF", "-DREPOSE_BENCHMARKS=OFF",
              "-DREPOSE_COMMAND=OFF", "-DCMAKE_INSTALL_LIBDIR=lib")
        cmake("--build", made / "engine")
        for prefix, component in ((made / "prefix", "runtime"), (made / "prefix", "development"),
                                  (to / "repose.libs", "runtime")):
            cmake("--install", made / "engine", "--prefix", prefix, "--component", component)
        cmake("-S", ROOT / "python", "-B", made / "module", *release, f"-DCMAKE_PREFIX_PATH={made / 'prefix'}",
              f"-DPYTHON_EXECUTABLE={sys.executable}", "-DREPOSE_PYTHON_FOLDER=.",
              "-DCMAKE_BUILD_WITH_INSTALL_RPATH=ON", "-DCMAKE_INSTALL_RPATH=$ORIGIN/repose.libs/lib")
        cmake("--build", made / "module")
        cmake("--install", made / "module", "--prefix", to)

    def get_outputs(self):
        to = pathlib.Path(self.get_ext_fullpath("repose")).parent
        return [str(path) for path in to.glob("repose*")]


version = re.search(r"project\(repose VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
setup(version=version, py_modules=[], packages=[], ext_modules=[Extension("repose", [])],
      cmdclass={"build_ext": BuildWithCMake})
