#!/usr/bin/env bash
# Makes the pictures of docs/tapa.md: what TAPA does with one view of the
# built-in example.
#
#   scripts/tapa_pictures.sh [OUT [OPTION ...]]
#
# The pictures go to OUT (docs/images/tapa). What follows goes to
# patch_match_stereo, for example --PatchMatchStereo.seed 1. VIEW names another
# view than room_05.jpg, WORK another folder than build/tapa_pictures for the
# workspace, which is made anew. Needs Debian's package python3-opencv, to make
# JPEGs.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
bin=${TAPA_BIN_DIR:-$root/build/bin}
data=$root/examples/room
view=${VIEW:-room_05.jpg}
work=${WORK:-$root/build/tapa_pictures}
out=${1:-$root/docs/images/tapa}
[[ $# -eq 0 ]] || shift

fail() {
  echo "ERROR: $*" >&2
  exit 1
}

[[ -x $bin/colmap ]] || fail "$bin has no colmap; run scripts/build.sh first"
[[ -f $data/images/$view ]] || fail "$data/images has no $view"
/usr/bin/python3 -c 'import cv2' 2>/dev/null ||
  fail "OpenCV for Python is missing; as root, run: apt-get install python3-opencv"

log=$work/stereo.log
mkdir -p "$work"
rm -rf "$work"/{workspace,pictures} "$log"
"$root/scripts/make_workspace.sh" "$data" "$work/workspace" >/dev/null
echo "Computing the maps of all views ..."
"$bin/colmap" patch_match_stereo --workspace_path "$work/workspace" \
  --PatchMatchStereo.tapa 1 --PatchMatchStereo.tapa_debug "$work/pictures" \
  "$@" >>"$log" 2>&1 ||
  fail "it failed; all output is in $log"

# Names must not depend on the content: the document links them. JPEG is smaller
# for all but the picture of few colours in large areas.
mkdir -p "$out"
/usr/bin/python3 - "$work/pictures/$view" "$out" <<'PYTHON'
import os
import sys

import cv2

MAX_BYTES = 690000

source, out = sys.argv[1:]
images = {os.path.splitext(name)[0]: cv2.imread(os.path.join(source, name))
          for name in sorted(os.listdir(source))}


def encode(stem, image, quality):
    if stem == "11_origin":
        return ".png", cv2.imencode(
            ".png", image, [cv2.IMWRITE_PNG_COMPRESSION, 9])[1].tobytes()
    return ".jpg", cv2.imencode(".jpg", image, [
        cv2.IMWRITE_JPEG_QUALITY, quality,
        cv2.IMWRITE_JPEG_OPTIMIZE, 1])[1].tobytes()


for quality in range(90, 20, -5):
    files = {stem: encode(stem, images[stem], quality) for stem in images}
    total = sum(len(data) for _, data in files.values())
    if total <= MAX_BYTES:
        break
for stem, (extension, data) in files.items():
    with open(os.path.join(out, stem + extension), "wb") as file:
        file.write(data)
print("%s: %d kB, JPEG quality %d" % (out, total / 1000, quality))
PYTHON
