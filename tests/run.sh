#!/usr/bin/env bash
# Installs what is missing, builds, and runs the tests.
#   bash tests/run.sh               every test but the long ones
#   bash tests/run.sh --all         the long ones too
#   bash tests/run.sh --build-only  stops after the build
# REPOSE_PRESET chooses the preset (default: release).
set -euo pipefail
cd "$(dirname "$0")/.."

build_only=false all=false
for word in "$@"; do
  case "$word" in
    --build-only) build_only=true ;;
    --all) all=true ;;
    *) echo "usage: bash tests/run.sh [--build-only] [--all]" >&2; exit 64 ;;
  esac
done

packages=--tests
$all && packages=--all
bash cmake/packages.sh $packages
preset=${REPOSE_PRESET:-release}
jobs=$(nproc)
cmake --preset "$preset" -DREPOSE_TESTS=ON -DREPOSE_BENCHMARKS=ON >"/tmp/repose-configure-$$.log" 2>&1 || { cat "/tmp/repose-configure-$$.log"; exit 1; }
rm -f "/tmp/repose-configure-$$.log"
cmake --build "build/$preset" -j "$jobs"
$build_only && exit 0

# Physics tests use every core by themselves: they run one at a time, the rest side by side.
labels=(-LE long)
$all && labels=()
ctest --test-dir "build/$preset" --output-on-failure -j "$jobs" "${labels[@]}"
