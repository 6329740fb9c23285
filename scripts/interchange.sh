#!/usr/bin/env bash
# Exchanges models, workspaces and depth maps with today's COLMAP, both ways, and
# checks the numbers ("here" is our program, "there" or "today" the other).
#
#   scripts/interchange.sh [PHOTOS [OUT]]
#
# PHOTOS is a folder of photographs (examples/room/images), OUT takes everything
# that is made (build/interchange). Today's COLMAP is its Python package, pycolmap,
# installed into an environment that is thrown away at the end; the download is kept
# in OUT/wheels and works offline from then on. One line is printed per check;
# docs/interchange.md tells what they mean.
#
# Exit status: 0 all well, 1 a check failed, 77 the package could not be had. From
# the environment:
#
#   TAPA_BIN_DIR          where colmap stands (build/bin)
#   MAX_IMAGE_SIZE=360    of the depth maps, in pixels; photographs are used at up to
#                         twice that size. The checks' limits are for 300 and more.
#   PYCOLMAP=pycolmap     what pip is asked for, for example pycolmap==4.2.1
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
root=$(dirname "$here")
source "$here/python_environment.sh"
requirement=${PYCOLMAP:-pycolmap}
size=${MAX_IMAGE_SIZE:-360}

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

skip() {
  echo "SKIPPED: $*"
  exit 77
}

[[ $# -le 2 ]] || fail "usage: $(basename "$0") [PHOTOS [OUT]]"
[[ $size =~ ^[1-9][0-9]*$ ]] ||
  fail "MAX_IMAGE_SIZE is $size, but must be a positive number"
bin=${TAPA_BIN_DIR:-$root/build/bin}
colmap=$bin/colmap
stereo=(--PatchMatchStereo.max_image_size "$size")
[[ -x $colmap ]] || fail "$bin has no colmap; run scripts/build.sh first"
photos=${1:-$root/examples/room/images}
[[ -d $photos ]] || fail "there is no folder $photos"
photos=$(cd "$photos" && pwd)
out=${2:-$root/build/interchange}
# What an earlier run left is removed, and nothing else.
[[ -e $out/.interchange || -z $(ls -A "$out" 2>/dev/null) ]] ||
  fail "$out is not empty and was not made by this script"
mkdir -p "$out"
out=$(cd "$out" && pwd)
touch "$out/.interchange"
rm -rf "$out"/{logs,photos,theirs,ours,environment.*}
logs=$out/logs
mkdir -p "$out/wheels" "$logs"
temporary=$(mktemp -d "$out/environment.XXXXXX")
trap 'rm -rf "$temporary"' EXIT

environment=$temporary/venv
make_environment "$environment" "$logs/venv.log" ||
  skip "python3 cannot make virtual environments here (the package python3-venv is missing)"
download_packages "$environment" "$out/wheels" "$logs/pip.log" "$requirement"
install_packages "$environment" "$out/wheels" "$logs/pip.log" "$requirement" ||
  skip "PyPI cannot be reached, or has no $requirement for this machine ($logs/pip.log)"
python=$environment/bin/python

# Runs a command whose output only matters when it fails.
step() {
  local name=$1 log
  shift
  log=$logs/$(tr -cs 'a-z\n' '_' <<<"$name").log
  echo "  ... $name"
  if ! "$@" >"$log" 2>&1; then
    tail -n 15 "$log" >&2
    fail "$name failed: $log"
  fi
}

today() { step "today: $1" "$python" "$here/interchange/today.py" "${@:2}"; }
ours() { step "here: $1" "$colmap" "${@:2}"; }

failed=0
check() {
  "$python" "$here/interchange/checks.py" "$@" 2>"$logs/checks.log" || {
    grep -v '^[IW][0-9]' "$logs/checks.log" | tail -n 5 >&2 || true
    failed=1
  }
}

mkdir -p "$out"/ours/{sparse,rewritten,rigs}
started=$SECONDS
check versions

echo "A model and a workspace of today's COLMAP, used here:"
today "shrink the photographs" shrink "$photos" "$out/photos" $((2 * size))
today "sparse model" reconstruct "$out/photos" "$out/theirs"
today "undistort" undistort "$out/photos" "$out/theirs/sparse" "$out/theirs/dense"
ours "rewrite their model" model_converter --output_type BIN \
  --input_path "$out/theirs/sparse" --output_path "$out/ours/rewritten"
ours "dense stereo in their workspace" patch_match_stereo \
  --workspace_path "$out/theirs/dense" \
  "${stereo[@]}"
# By the rule that is theirs as well.
ours "fuse our maps" stereo_fusion --workspace_path "$out/theirs/dense" \
  --output_path "$out/theirs/fused_here.ply" --StereoFusion.agreement 0
check same_model "$out/theirs/sparse" "$out/ours/rewritten"
check depth_maps "$out/theirs/dense"
today "a model with camera rigs" make_rigs "$out/theirs/rigs"
ours "rewrite the model with camera rigs" model_converter --output_type BIN \
  --input_path "$out/theirs/rigs" --output_path "$out/ours/rigs"
check same_model "$out/theirs/rigs" "$out/ours/rigs"

echo "Our maps, used by today's COLMAP:"
today "fuse our maps" fuse "$out/theirs/dense" "$out/theirs/fused_today.ply"
check map_files "$out/theirs/dense"
check fused "$out/theirs/dense" "$out/theirs/fused_today.ply" \
  "$out/theirs/fused_here.ply"

echo "Maps written by today's COLMAP, used here:"
today "rewrite our maps" rewrite_maps "$out/theirs/dense" "$out/theirs/rewritten"
ours "geometric pass of one view from their maps" patch_match_stereo \
  --workspace_path "$out/theirs/rewritten" \
  --config_path "$out/theirs/rewritten/one-view.cfg" \
  "${stereo[@]}"
check same_maps "$out/theirs/dense" "$out/theirs/rewritten"

echo "A model and a workspace of ours, used by today's COLMAP:"
ours "features" feature_extractor --database_path "$out/ours/database.db" \
  --image_path "$out/photos" --ImageReader.single_camera 1 \
  --SiftExtraction.use_gpu 0
ours "matches" exhaustive_matcher --database_path "$out/ours/database.db" \
  --SiftMatching.use_gpu 0
ours "sparse model" mapper --database_path "$out/ours/database.db" \
  --image_path "$out/photos" --output_path "$out/ours/sparse"
ours "undistort" image_undistorter --image_path "$out/photos" \
  --input_path "$out/ours/sparse/0" --output_path "$out/ours/dense"
"$colmap" model_analyzer --path "$out/ours/sparse/0" >"$out/ours/analysis.txt" 2>&1
today "rewrite our model" rewrite_model "$out/ours/sparse/0" "$out/theirs/model"
today "undistort with our model" undistort "$out/photos" "$out/ours/sparse/0" \
  "$out/theirs/undistorted"
check read_model "$out/ours/sparse/0" "$out/ours/analysis.txt"
check same_model "$out/ours/sparse/0" "$out/theirs/model"
check same_cameras "$out/ours/dense/sparse" "$out/theirs/undistorted/sparse"
check same_poses "$out/theirs/sparse" "$out/ours/sparse/0"

echo "$((SECONDS - started)) s; everything is in $out"
[[ $failed == 0 ]] || fail "at least one check failed"
