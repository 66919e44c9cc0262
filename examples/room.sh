#!/bin/sh
# room.sh: the furnished room of examples/room.scene with global illumination, each object with a material of the
# shipped model.
#
#   sh examples/room.sh OUT [RGL]
#
# writes OUT/room.exr and room.png. With RGL, a folder with the measurements (NAME_rgb.bsdf), also room_ggx and
# room_measured: the same scene with GGX alone and with the measurements, and a table of errors and times, which
# goes to OUT/room.csv too. SPP (default 256) samples a pixel, WIDTH (default 720) pixels across.
set -eu
here=$(dirname "$0")
hnbrdf=${HNBRDF:-$here/../build/hnbrdf}
out=$1 rgl=${2:-}
mkdir -p "$out"
set -- "$here/room.scene" --spp "${SPP:-256}" --width "${WIDTH:-720}" --clamp 3 -o "$out/room.exr"
if [ -n "$rgl" ]; then
    "$hnbrdf" scene "$@" --compare "$rgl" --csv "$out/room.csv"
else
    "$hnbrdf" scene "$@"
fi
