#!/usr/bin/env bash
# What a scene does not name costs nothing: the command against a build of it that has no effects but gravity and
# solids. Same bits, same bytes per particle, as many instructions; times are shown, but machines are too noisy to
# fail on them.
#   off_costs_nothing.sh SOURCE BARE_BUILD REPOSE NO_TIMER [CMAKE_ARGUMENT ...]
set -euo pipefail
source=$1 bare=$2 repose=$3 no_timer=$4
shift 4
here=$(dirname "$0")
command -v valgrind >/dev/null || { echo "valgrind is missing: bash cmake/packages.sh --all" >&2; exit 1; }

log=$bare.log
mkdir -p "$(dirname "$bare")"
if ! { cmake -S "$source" -B "$bare" -DREPOSE_BARE=ON -DREPOSE_TESTS=OFF -DREPOSE_BENCHMARKS=OFF "$@" &&
       cmake --build "$bare" --target repose -j "$(nproc)"; } >"$log" 2>&1; then
  tail -40 "$log" >&2
  exit 1
fi
/usr/bin/python3 "$here/off_costs_nothing.py" "$repose" "$bare/apps/repose/repose" "$no_timer" "$here"
