#!/usr/bin/env bash
# The committed studies (bench/studies): accuracy against time.
#   bash bench/study.sh            all of them in full: hours; one that was interrupted goes on
#   bash bench/study.sh --quick    bar, vortex and columns with fewer points: under 10 minutes on 2 cores
#   bash bench/study.sh NAME...    some of them; presets and plane_presets are those of --quality
# Runs are made on one thread, so that their time is also that of the core. Pages are written to out/studies (STUDY_OUT),
# a folder each. REPOSE names the program to use.
set -euo pipefail
cd "$(dirname "$0")/.."

# Presets are points of the columns' fronts.
scene_of() {
  case "$1" in
    presets) echo bench/studies/column.json ;;
    plane_presets) echo bench/studies/plane_column.json ;;
    *) echo "bench/studies/$1.json" ;;
  esac
}

quick=false names=()
for word in "$@"; do
  case "$word" in
    --quick) quick=true ;;
    -*) sed -n '2,8s/^# *//p' "$0" >&2; exit 64 ;;
    *)
      [ -f "$(scene_of "$word")" ] || { echo "bench/studies has no $word.json" >&2; exit 66; }
      names+=("$word") ;;
  esac
done

repose=${REPOSE:-build/release/apps/repose/repose}
if [ ! -x "$repose" ]; then
  cmake --preset release >/dev/null
  cmake --build --preset release --target repose
fi
out=${STUDY_OUT:-out/studies}

study() {  # NAME, then what a quick one changes
  local name=$1
  shift
  if [ ${#names[@]} -gt 0 ] && [[ " ${names[*]} " != *" $name "* ]]; then return; fi
  local folder=$out/$name change=()
  if $quick; then folder=$folder-quick; fi
  if $quick || [[ $name == *presets ]]; then change=("$@"); fi
  echo "$name"
  "$repose" study "$(scene_of "$name")" --out "$folder" --threads 1 "${change[@]}"
}

transfers=grid.transfer=mls_apic,aflip,flip
study bar --vary parameters.cells=16,32,64 --vary "$transfers" --repeat 3
study vortex --vary parameters.cells=12,16,24 --vary "$transfers" --seeds 2 --repeat 1
study plane_column --vary parameters.cells=8,12,16 --vary "$transfers" --seeds 3 --repeat 1 \
  --reference "finest:parameters.cells=32" --reference-seeds 4
study column --vary parameters.cells=4,6,8,10 --vary grid.transfer=mls_apic,aflip \
  --vary bodies.column.particles_per_cell=4,8 --seeds 2 --repeat 1 \
  --reference "finest:parameters.cells=20" --reference-seeds 4
$quick || study box

# draft, standard and reference: twice the spacing of the column, its own, and half of it.
presets() {  # NAME, cells of the grid that is finer than all, runs of it
  study "$1" --vary parameters.cells=8,16,32 --seeds 8 --repeat 1 --reference "finest:parameters.cells=$2" --reference-seeds "$3"
}
$quick || presets presets 48 4
$quick || presets plane_presets 64 8

# Beyond what --quick makes unless it is asked for by name.
if ! $quick || [ ${#names[@]} -gt 0 ]; then
  correction="volume_correction=absent,{}"
  study incline --vary parameters.cells=3,6,12 --vary "$transfers" --seeds 2
  study silo --vary parameters.cells=8,16 --vary grid.transfer=mls_apic,aflip --vary "$correction" --seeds 2 \
    --reference "finest:parameters.cells=32" --reference-seeds 1
  study hourglass --vary parameters.cells=4,6 --vary grid.transfer=mls_apic,aflip --vary "$correction" --seeds 2 \
    --reference "finest:parameters.cells=12; volume_correction={}" --reference-seeds 1
  study drum --vary grid.transfer=mls_apic,aflip --vary "density_correction=absent,{}" --vary "$correction" --seeds 3 \
    --reference "finest:parameters.cells=40; density_correction={}; volume_correction={}" --reference-seeds 1
  study oedometer --vary parameters.cells=16,32 --vary bodies.block.particles_per_cell=4,9,16 \
    --vary bodies.block.sampling=jittered,poisson_disk --seeds 1
  study softness --set parameters.cells=8 --vary grid.transfer=mls_apic,aflip \
    --vary parameters.youngs_modulus=3.537e4,3.537e5,3.537e6,3.537e7 --seeds 3 \
    --reference "finest:parameters.youngs_modulus=3.537e8; grid.transfer=aflip" --reference-seeds 2
fi
