#!/usr/bin/env bash
# Builds with the specimens in the lists, and runs the tests that go over those lists, and their own.
#   specimens.sh SOURCE BUILD [CMAKE_ARGUMENT ...]
set -euo pipefail
source=$1 build=$2
shift 2
log=$build.log
mkdir -p "$(dirname "$build")"
programs=(kernels_test engine_test effect_trials_test specimens_test)
if ! { cmake -S "$source" -B "$build" -DREPOSE_SPECIMENS=ON -DREPOSE_TESTS=ON -DREPOSE_BENCHMARKS=ON "$@" &&
       cmake --build "$build" --target "${programs[@]}" -j "$(nproc)"; } >"$log" 2>&1; then
  tail -40 "$log" >&2
  exit 1
fi
cd "$build"
tests/kernels/kernels_test --gtest_brief=1
tests/engine/engine_test --gtest_brief=1 --gtest_filter='EveryEffect.*:SceneSchema.Root*'
tests/bench/effect_trials_test --gtest_brief=1
tests/specimens/specimens_test --gtest_brief=1
