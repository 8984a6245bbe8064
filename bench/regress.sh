#!/usr/bin/env bash
# Whether anything takes more than it did: instructions, branches and cache misses per step, bytes, allocations, steps,
# iterations, hashes, against bench/baselines. Counts repeat on any machine with AVX2; times do not, and are compared in
# pairs alone.
#   bash bench/regress.sh [--quick | --only CASE,...] [--report FOLDER]   0: as before, 1: worse, or other than accepted, 2: not measured
#     --lines: of a build with lines of the sources (build/lines), so that a report names them
#   bash bench/regress.sh --accept "REASON"             what is measured now is right; the reason goes into the log
#   bash bench/regress.sh --ab BASE HEAD [--pairs N]    processor time of two commits, or of two builds of the command
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '5,8s/^# *//p' "$0" >&2; exit 64; }

# A commit is built beside the checkout's own builds; a file is taken as it is.
command_of() {
  if [ -f "$1" ] && [ -x "$1" ]; then
    realpath "$1"
    return
  fi
  local commit tree
  commit=$(git rev-parse --verify --quiet "$1^{commit}") || { echo "regress: '$1' is no commit and no program" >&2; exit 2; }
  tree=build/ab/$commit
  if [ ! -x "$tree/build/release/apps/repose/repose" ]; then
    [ -d "$tree" ] || git worktree add --detach "$tree" "$commit" >&2
    cmake -S "$tree" -B "$tree/build/release" --preset release -DREPOSE_TESTS=OFF -DREPOSE_BENCHMARKS=OFF >&2
    cmake --build "$tree/build/release" -j "$(nproc)" --target repose >&2
  fi
  realpath "$tree/build/release/apps/repose/repose"
}

if [ "${1:-}" = --ab ]; then
  [ $# -ge 3 ] || usage
  base=$(command_of "$2") head=$(command_of "$3")
  shift 3
  exec python3 bench/regress/regress.py ab "$base" "$head" "$@"
fi
for word in "$@"; do
  case "$word" in -h | --help) usage ;; esac
done
command -v valgrind >/dev/null || { echo "regress: valgrind is missing (bash cmake/packages.sh --all installs it)" >&2; exit 2; }
build=build/release words=()
for word in "$@"; do
  if [ "$word" = --lines ]; then build=build/lines; else words+=("$word"); fi
done
with_lines=()
if [ $build = build/lines ]; then with_lines=(-DCMAKE_CXX_FLAGS=-g1); fi
cmake --preset release -B $build -DREPOSE_TESTS=ON "${with_lines[@]}" >/dev/null
cmake --build $build -j "$(nproc)" --target repose no_timer >&2
exec python3 bench/regress/regress.py gate $build/apps/repose/repose \
  --no-timer "$(find "$PWD/$build" -name 'libno_timer.so' -print -quit)" --baselines bench/baselines "${words[@]}"
