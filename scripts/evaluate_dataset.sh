#!/usr/bin/env bash
# Runs dense stereo on a data set with measured depth and scores its maps.
#
#   scripts/evaluate_dataset.sh DATA OUT [OPTION ...]
#
# DATA has images/, sparse/ and gt_depth/ (see examples/room/README.md). The
# workspace, scores.json, scores.txt and, if PICTURES is 1, pictures/ go to OUT.
# What follows goes to patch_match_stereo, for example
# --PatchMatchStereo.max_image_size 768. From the environment:
#
#   SOURCES=10  EVERY=1          as in make_workspace.sh
#   TOLERANCES=0.05,0.1          in metres
#   RELATIVE_TOLERANCES=0.5,1,2  in per cent of depth
#   MAX_TEXTURENESS=0.6,0.75     also score the pixels of lower textureness
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
bin=${TAPA_BIN_DIR:-$here/../build/bin}

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

[[ $# -ge 2 ]] || fail "usage: $(basename "$0") DATA OUT [OPTION ...]"
data=$1
out=$2
shift 2
[[ -x $bin/colmap ]] || fail "$bin has no colmap; run scripts/build.sh first"
[[ -d $data/gt_depth ]] || fail "$data has no folder gt_depth"

"$here/make_workspace.sh" "$data" "$out" "${SOURCES:-10}" "${EVERY:-1}"
"$bin/colmap" patch_match_stereo --workspace_path "$out" "$@"

more=()
[[ ${PICTURES:-0} == 0 ]] || more+=(--pictures "$out/pictures")
[[ -z ${MAX_TEXTURENESS:-} ]] || more+=(--max_textureness "$MAX_TEXTURENESS")
"$bin/evaluate_depth_maps" --workspace_path "$out" \
  --ground_truth_path "$data/gt_depth" \
  --tolerances "${TOLERANCES:-0.01,0.02,0.05,0.1,0.2}" \
  --relative_tolerances "${RELATIVE_TOLERANCES:-0.5,1,2}" \
  --json "$out/scores.json" "${more[@]}" | tee "$out/scores.txt"
