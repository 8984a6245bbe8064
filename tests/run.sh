#!/usr/bin/env bash
# Installs what is missing, builds, runs the tests, and counts what steps take (bench/regress.sh --quick).
#   bash tests/run.sh                      every test but the long ones
#   bash tests/run.sh --all [PART]         the long ones too: all of them, or one part of them alone:
#                                          stability, sanitizers, consumers, fuzz, rest; or, which is no part of
#                                          all since it builds the engine over and over, breaks: whether each hard
#                                          case notices a broken engine (tests/stability/breaks.py)
#   bash tests/run.sh --stability [--page FILE]
#                                          the battery of hard cases as a table, and as a page of Markdown
#   bash tests/run.sh --validation [--page FILE]
#                                          the laws, each with its control, in the same way
#   bash tests/run.sh --build-only         stops after the build
# REPOSE_PRESET chooses the preset (default: release).
set -euo pipefail
cd "$(dirname "$0")/.."

usage() { sed -n '2,13s/^# *//p' "$0" >&2; exit 64; }

build_only=false all=false table= part= page=
while [ $# -gt 0 ]; do
  case "$1" in
    --build-only) build_only=true ;;
    --all)
      all=true
      case "${2:-}" in
        stability | sanitizers | consumers | fuzz | rest | breaks) part=$2; shift ;;
        "" | --*) ;;
        *) usage ;;
      esac ;;
    --stability) table=battery ;;
    --validation) table=laws ;;
    --page) [ $# -gt 1 ] || usage; page=$2; shift ;;
    *) usage ;;
  esac
  shift
done
[ -z "$page" ] || [ -n "$table" ] || usage

packages=--tests
$all && packages=--all
bash cmake/packages.sh $packages
preset=${REPOSE_PRESET:-release}
jobs=$(nproc)

build() {  # PRESET
  local log
  log=$(mktemp)
  cmake --preset "$1" -DREPOSE_TESTS=ON -DREPOSE_BENCHMARKS=ON >"$log" 2>&1 || { cat "$log"; rm -f "$log"; exit 1; }
  rm -f "$log"
  cmake --build "build/$1" -j "$jobs"
}

run() {  # PRESET, then what chooses tests
  local in=$1
  shift
  ctest --test-dir "build/$in" --output-on-failure -j "$jobs" "$@"
}

# Address, undefined behaviour and threads. The thread sanitizer is for what threads share: kernels, order, steps.
sanitizers() {
  build asan
  run asan -LE long
  build tsan
  TSAN_OPTIONS="suppressions=$PWD/tests/threads.supp" run tsan -L unit -R 'Kernel|Scatter|Gather|BlockSort|State|ParticleEdit|Stepper|StepPlan|Determinism'
}

# What a step takes must not have grown; the baseline is of this preset's programs.
gate() {
  [ "$preset" = release ] || return 0
  if ! command -v valgrind >/dev/null || ! grep -qw avx2 /proc/cpuinfo; then
    echo "what a step takes is not compared: that needs valgrind, and AVX2"
    return 0
  fi
  bash bench/regress.sh --quick --tell-elsewhere
}

case "$part" in
  sanitizers) sanitizers; exit ;;
  breaks) exec python3 tests/stability/breaks.py --jobs "$jobs" ;;
esac

build "$preset"
$build_only && exit 0

if [ -n "$table" ]; then
  python3 tests/table.py "$table" "build/$preset" ${page:+--page "$page"}
  exit
fi
# Physics tests use every core by themselves: they run one at a time, the rest side by side.
case "$part" in
  "") if $all; then run "$preset"; gate; sanitizers; else run "$preset" -LE long; gate; fi ;;
  stability) run "$preset" -L stability ;;
  consumers) run "$preset" -L consumers ;;
  fuzz) run "$preset" -L fuzz ;;
  rest) run "$preset" -L long -LE 'stability|consumers|fuzz' ;;
esac
