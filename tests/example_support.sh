# example_support.sh: what the tests of examples, in --help and on pages, share. Sourced by them in a scratch folder,
# with HNBRDF, FILES and SOURCES set and `fail` defined: makes the folder `start` with the files that examples name, the
# list `shorter`, and `hnbrdf` the command.

# PATTERN|WORDS|WHY: of the first pattern that fits, these words are put behind the command's name; - stands for an
# example that is not run.
cat >shorter <<'END'
cmake -S*|-|test_install and test_minimal build the whole
sh examples/demo.sh*|-|five minutes; tests/first_use.sh runs it
sh tests/run.sh*|-|runs this test
sh examples/bench.sh*|-|minutes; test_bench runs the command
*sh examples/room.sh*|-|minutes; test_scene_cli renders the room
build/examples/path_tracer*|-|minutes of this size; test_path_tracer runs it
my_engine *|-|the program of the reader
npm *|-|needs the network; test_web* run the pages
fit *nbrdf/*|-|networks of others, which are not here
fit *--kind ggx*|--pool 64|training takes a minute
fit *--seconds*|-|trains for as long as it says
fit *--steps 1?????*|-|trains for as long as it says
fit *procedural:[1-9][0-9][0-9]*|-|trains for as long as it says
fit *|--pool 64 --steps 2|training takes a minute
compare *--images*||pictures of 8 x 8 pixels are there
compare *--pairs*||two small files of data
compare *|--pairs 10|100 thousand pairs of each of 16 materials
verify --list||no device is used, only named
verify *|-|a minute on a processor; test_gpu_cli runs the command
stability *|-|seconds for each model; test_stability_cli runs the command
render *--device*|-|test_gpu_cli runs the command
render *--time*|-|renders for as long as it says
render *--spp*|--size 8|large pictures
render *|--size 8 --spp 1|large pictures
scene examples/*|--width 16 --spp 1|a large picture
scene *--time*|-|renders for as long as it says
scene *--resume*|-|goes on from the one before
scene *|--spp 1|many samples
sheet *--size*|--spp 1|many samples
sheet *|--size 32 --spp 1|large pictures
gallery *--seconds*|-|fits for as long as it says
gallery *|--size 32 --spp 1|large pictures
bake *--seconds*|-|fits for as long as it says
bake *--max*|-|tries networks until one is good or fast enough
bake *--front*|-|fits networks of all sizes
bake *|--steps 1 --pairs 100 --pool 64|training takes a minute
report *|-|half an hour; test_report* run the commands
bench *|-|a minute; test_bench runs the command
END

"$FILES" . || exit 1
mkdir bin start
ln -s "$HNBRDF" bin/hnbrdf
PATH=$SCRATCH/bin:$PATH

# What the examples name.
fill() {
    hnbrdf fit builtin --net 8x1 --steps 2 --pool 64 -o model.safetensors
    hnbrdf fit builtin --kind ggx --pool 64 -o ggx.safetensors
    for copy in a b old hybrid; do cp model.safetensors $copy.safetensors; done
    mkdir rgl measured merl
    cp model.safetensors trained.safetensors
    for name in vch_silk_blue new; do cp ../lambert_rgb.bsdf rgl/$name.bsdf; done
    hnbrdf fit rgl --net 8x1 --steps 2 --pool 64 -o rgl.safetensors
    hnbrdf fit rgl --kind ggx --pool 64 -o rgl_ggx.safetensors
    mv rgl/new.bsdf .
    cp -r rgl measured/rgl
    for name in gold-paint blue-fabric nickel pvc; do cp ../lambert_rgb.bsdf merl/$name.bsdf; done
    hnbrdf fit merl --net 8x1 --steps 2 --pool 64 -o merl.safetensors
    rm merl/*
    for name in gold alum-bronze chrome merl/a merl/b; do ln -s "$SCRATCH/lambert.binary" $name.binary; done
    cp ../a.brdf ../b.brdf merl
    for name in studio uffizi; do cp ../sky.hdr $name.hdr; done
    printf 'wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0.6,0,0.8,0,0,1\n' >pairs.csv
    printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n' >bunny.obj
    printf 'camera from 0 0 4 to 0 0 0 fov 40\nsize 4 3\nenvironment sky\nmaterial a model "rgl.safetensors" vch_silk_blue\n%s\n' \
        'shape sphere material a' >room.scene
    hnbrdf render builtin:rough-clay --size 8 --spp 1 -o reference.exr
    for copy in hybrid ggx a; do cp reference.exr $copy.exr; done
    ln -s "$SOURCES/examples" examples
}
(cd start && set -e && fill) >out 2>err </dev/null || { fail "the files that the examples name"; finish; }

# words_for EXAMPLE: sets words and why.
words_for() {
    while IFS='|' read -r pattern words why; do
        # shellcheck disable=SC2254 # it is a pattern
        case $1 in $pattern) return ;; esac
    done <shorter
    words='' why=''
}

# try_example LINE: runs it in the folder `here`, shortened; counts in `seen` and, if it is only looked at, in `left`.
try_example() {
    words_for "$(echo "$1" | sed 's/.*hnbrdf //')"
    seen=$((seen + 1))
    [ "$words" != - ] || { left=$((left + 1)) && return; }
    name=$(echo "$1" | sed -n 's/.*hnbrdf \(report [a-z]*\|[a-z]*\).*/\1/p')
    line=$(echo "$1" | sed "s#hnbrdf $name#& $words#")
    (cd here && sh -c "$line" >../out 2>../err </dev/null)
    rc=$?
    [ "$rc" -eq 0 ] || fail "$line: exit $rc"
    ! grep '^hnbrdf' err | grep -qv '^hnbrdf: warning: ' || fail "$line: complains"
}

# Nobody keeps a line without a reason.
while IFS='|' read -r pattern words why; do
    [ -n "$why" ] || fail "$pattern: no reason"
done <shorter
