#!/usr/bin/env bash
# Installs the Debian packages that are missing: those to build and run, with --tests those that the tests read
# files with, and with --all those of the long tests too. Does nothing where everything is there.
set -euo pipefail

optional=()  # a test that lacks one says so and is skipped
packages=(g++ cmake ninja-build pkg-config ccache libopenvdb-dev libboost-iostreams-dev libeigen3-dev libtbb-dev
          libhwy-dev libjsoncpp-dev libcli11-dev libmuparser-dev libpng-dev zlib1g-dev ffmpeg)
if [ "${1:-}" = "--tests" ] || [ "${1:-}" = "--all" ]; then
  packages+=(libgtest-dev libgmock-dev libbenchmark-dev libopenvdb-tools python3 python3-meshio python3-vtk9
             pybind11-dev python3-pybind11 python3-dev python3-numpy abigail-tools doxygen)
  optional+=(chromium-headless-shell valgrind)
fi
[ "${1:-}" = "--all" ] && packages+=(valgrind dpkg-dev file lintian)

installed() { dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'install ok installed'; }
missing=() wanted=()
for package in "${packages[@]}"; do installed "$package" || missing+=("$package"); done
for package in "${optional[@]}"; do installed "$package" || wanted+=("$package"); done
[ ${#missing[@]} -eq 0 ] && [ ${#wanted[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || [ ${#missing[@]} -gt 0 ] || exit 0
  command -v sudo >/dev/null || { echo "please install as root: ${missing[*]}" >&2; exit 1; }
  as_root=(sudo)
fi
echo "installing ${missing[*]} ${wanted[*]}"
export DEBIAN_FRONTEND=noninteractive
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" apt-get install -y --no-install-recommends "${missing[@]}"; } \
    >"$log" 2>&1; then
  tail -20 "$log" >&2
  echo "installing failed; the packages are those of Debian 12" >&2
  exit 1
fi
for package in "${wanted[@]}"; do
  "${as_root[@]}" apt-get install -y --no-install-recommends "$package" >"$log" 2>&1 ||
    echo "$package cannot be installed; what needs it is skipped" >&2
done
