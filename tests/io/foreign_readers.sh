#!/usr/bin/env bash
# Points as other programs read them: a sample of every format, then the output of a real run.
#   foreign_readers.sh WRITE_SAMPLES REPOSE FOREIGN_READERS
set -euo pipefail
write_samples=$1 repose=$2 readers=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$write_samples" "$folder/samples"
/usr/bin/python3 "$readers" "$folder/samples"

cat >"$folder/scene.json" <<'SCENE'
{"repose": 1, "name": "tiny", "grid": {"spacing": 0.02}, "time": {"frames": 1, "frames_per_second": 100},
 "materials": {"sand": {"type": "drucker_prager"}, "rubber": {"type": "elastic"}},
 "bodies": [{"name": "a", "material": "sand",
             "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.1, 0.1, 0.1]}},
            {"name": "b", "material": "rubber",
             "shape": {"type": "sphere", "center": [0.05, 0.2, 0.05], "radius": 0.05}}],
 "output": {"vdb": true, "ply": true, "vtp": true, "attributes": ["stress", "speed"], "surface": {}, "fog": {}}}
SCENE
"$repose" run "$folder/scene.json" --out "$folder/run" --quiet
# What the run says of itself in run.json is what the foreign readers must find.
/usr/bin/python3 - "$folder/run" <<'PYTHON'
import json, sys
folder = sys.argv[1]
log = json.load(open(folder + "/run.json"))
frame = log["frames"][0]
figures = {"count": frame["particles"], "first_ids": [0, 1, 2], "bounds": [frame["lower"], frame["upper"]],
           "spacing": log["scene"]["spacing"], "attributes": ["material", "speed"],
           "tensors": ["stress"]}
json.dump(figures, open(folder + "/tiny.points.json", "w"))
PYTHON
/usr/bin/python3 "$readers" "$folder/run" --name tiny.points

# Name, type and number of voxels of each grid, which must be more than none.
expect_grid() {
  vdb_print "$folder/run/tiny.$1.0001.vdb" | grep -E "^$2 +$3 .* [1-9][0-9,.]*(K|M)?Vox" >/dev/null ||
    { echo "WRONG vdb_print: no grid $2 of $3 in the $1"; exit 1; }
  echo "ok    vdb_print: a grid $2 of $3 in the $1"
}
expect_grid surface surface float
expect_grid fog density float
expect_grid fog v vec3s
