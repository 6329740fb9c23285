#!/usr/bin/env bash
# From photographs to points.
#
#   scripts/demo.sh                 the built-in example, without and with TAPA,
#                                   with scores
#   scripts/demo.sh PHOTOS [OUT]    a folder of photographs, with TAPA; the result
#                                   goes to OUT (PHOTOS-reconstruction beside it);
#                                   OUT/result.html shows all of it in a browser
#
# Installs what is missing and builds the program first, unless TAPA_BIN_DIR names the
# bin/ of another build. A run that was stopped goes on where it left off. Photographs
# are scaled down to at most MAX_IMAGE_SIZE (1600) pixels before dense stereo. BUILD_DIR
# names another folder than build/.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
build=${BUILD_DIR:-$root/build}
bin=${TAPA_BIN_DIR:-$build/bin}

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

run() {
  echo "\$ ${*/#$root\//}" >&2
  "$@"
}

# run_quietly WHAT COUNT COMMAND...: its output goes into a log beside the results;
# how far it is, of COUNT photographs, is shown.
run_quietly() {
  local what=$1 count=$2
  shift 2
  run "$@" | "$here/progress.sh" "$what" "$out/demo.log" "$count" ||
    fail "this failed: $what; see $out/demo.log"
}

# Once with COLMAP's own algorithm, once with TAPA, which completes the walls.
reconstruct_example() {
  local out=$build/demo
  mkdir -p "$out"
  echo "It takes some minutes on all cores and 0.5 GB in $out."
  run "$here/evaluate" "$root/examples/room" --out "$out" --num_views 3
  echo
  sed -n '/^## room/,/^!/ { /^!/d; p }' "$out/report.md" # Without its pictures.
  echo "Report:   $out/report.md, and as a page to open in a browser $out/report.html"
  echo "Pictures: $out/figures/"
  echo "Points:   $out/room/plain-0/fused_agreement.ply, $out/room/tapa-0/fused_agreement.ply"
}

# Folder of the largest of the models that the mapper made.
largest_model() {
  local model best= count most=0
  for model in "$1"/*/; do
    count=$("$bin/colmap" model_analyzer --path "$model" 2>&1 |
      sed -n 's/.*Registered images: *\([0-9]*\).*/\1/p')
    if [[ ${count:-0} -gt $most ]]; then
      most=$count
      best=$model
    fi
  done
  [[ -n $best ]] || return 1
  echo "$best"
}

# Names of the photographs in folder $1, without hidden files and what is in $2.
list_photographs() {
  (cd "$1" && find -L . -samefile "$2" -prune -o \
    -type f -not -name '.*' \
    -iregex '.*\.\(jpe?g\|png\|tiff?\|bmp\|ppm\)' -print) |
    sed 's|^\./||' | LC_ALL=C sort
}

# Camera poses and sparse points, unless a run before has them.
reconstruct_sparse() {
  local photos=$1 out=$2 count=$3
  # Of small blocks, after each of which it tells how far it is.
  local matcher=(exhaustive_matcher --ExhaustiveMatching.block_size 20)
  [[ ! -f $out/sparse.done ]] || return 0
  if [[ $count -gt 200 ]]; then
    matcher=(sequential_matcher)
    echo "More than 200 photographs: each is matched with its neighbours in the order of names only."
  fi
  run_quietly "Finding features" "$count" "$bin/colmap" feature_extractor \
    --database_path "$out/database.db" --image_path "$photos" \
    --image_list_path "$out/photographs.list" --SiftExtraction.use_gpu 0
  run_quietly "Matching features" "$count" "$bin/colmap" "${matcher[@]}" \
    --database_path "$out/database.db" --SiftMatching.use_gpu 0
  rm -rf "$out/sparse"
  mkdir -p "$out/sparse"
  run_quietly "Finding camera poses" "$count" "$bin/colmap" mapper \
    --database_path "$out/database.db" --image_path "$photos" \
    --output_path "$out/sparse"
  touch "$out/sparse.done"
}

reconstruct_photos() {
  local photos out=${2:-} size=${MAX_IMAGE_SIZE:-1600} list sums count model
  [[ -d $1 ]] || fail "there is no folder $1"
  photos=$(cd "$1" && pwd)
  mkdir -p "${out:=$photos-reconstruction}"
  out=$(cd "$out" && pwd)
  list=$(list_photographs "$photos" "$out")
  count=$(grep -c . <<<"$list" || true)
  [[ $count -ge 3 ]] || fail "$photos has $count photographs; at least 3 are needed"
  # What was made in OUT must have been made from the same photographs.
  sums=$(cd "$photos" && tr '\n' '\0' <<<"$list" | xargs -0 cksum --)
  sums+=$'\n'"at most $size pixels"
  [[ ! -e $out/photographs.txt || $(<"$out/photographs.txt") == "$sums" ]] ||
    fail "$out has a reconstruction of other photographs or another MAX_IMAGE_SIZE; remove it or name another folder"
  echo "$sums" >"$out/photographs.txt"
  echo "$list" >"$out/photographs.list"

  reconstruct_sparse "$photos" "$out" "$count"
  model=$(largest_model "$out/sparse") ||
    fail "no camera poses could be found; take the photographs with more overlap"
  if [[ ! -f $out/dense/undistorted.done ]]; then
    run_quietly "Undistorting photographs" "$count" "$bin/colmap" \
      image_undistorter --image_path "$photos" --input_path "$model" \
      --output_path "$out/dense" --max_image_size "$size"
    touch "$out/dense/undistorted.done"
  fi
  # A photograph that sees nothing from another angle is left out. How far these are
  # is shown through stderr, past the logs.
  run "$bin/colmap" patch_match_stereo --workspace_path "$out/dense" \
    --PatchMatchStereo.allow_missing_files 1 --PatchMatchStereo.tapa 1 \
    --PatchMatchStereo.tapa_debug "$out/dense/tapa_debug" | tee -ia "$out/dense/stereo.log"
  run "$bin/colmap" stereo_fusion --workspace_path "$out/dense" \
    --output_path "$out/dense/fused.ply" | tee -ia "$out/dense/fusion.log"
  run "$bin/evaluate_depth_maps" --workspace_path "$out/dense" \
    --pictures "$out/pictures"
  echo
  echo "Pictures: $out/pictures/"
  echo "Points:   $out/dense/fused.ply"
  "$bin/result_page" "$out/dense" --out "$out/result.html" ||
    echo "WARNING: there is no page to show the result; $out has all of it."
}

[[ $# -le 2 ]] || fail "usage: $(basename "$0") [PHOTOS [OUT]]"
if [[ -z ${TAPA_BIN_DIR:-} ]]; then
  "$here/build.sh"
fi
export TAPA_BIN_DIR=$bin
if [[ $# -eq 0 ]]; then
  reconstruct_example
else
  reconstruct_photos "$@"
fi
