#!/usr/bin/env bash
# One command from a bare Debian 12 to a film: installs what is missing, builds, lets sand run through an hourglass,
# and renders it. Any further words go to `repose run`, such as --set grid.spacing=0.0025 for the paper's size.
set -euo pipefail
cd "$(dirname "$0")/.."

out=out/hourglass
bash cmake/packages.sh
echo "building (some minutes the first time)"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
cmake --preset release -DREPOSE_TESTS=OFF -DREPOSE_BENCHMARKS=OFF >"$log" 2>&1 || { cat "$log"; exit 1; }
cmake --build build/release --target repose -j "$(nproc)"

repose=build/release/apps/repose/repose
[[ " $* " == *" --resume "* ]] || set -- --overwrite "$@"
"$repose" run apps/scenes/hourglass.json --out "$out" \
  --set grid.spacing=0.005 --set time.frames_per_second=24 --set time.frames=72 "$@"
"$repose" info "$out"
"$repose" movie "$out"
echo
echo "caches (VDB points): $PWD/$out/hourglass.points.*.vdb"
echo "log:                 $PWD/$out/run.json"
echo "film:                $PWD/$out/hourglass.mp4"
