#!/bin/sh
# COLMAP, which computes dense stereo on an emulated GPU. Built programs are in
# the folder above.
bin=$(dirname "$0")/..
if [ "$1" = patch_match_stereo ]; then
  shift
  exec "$bin/emulated_gpu_stereo" "$@"
fi
exec "$bin/colmap" "$@"
