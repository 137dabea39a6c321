#!/bin/sh
# Runs the scenes that touch themselves from starts that are shaken by about a micrometre in the first step, on several
# meshes, with edges of three and more thicknesses too: at the end of no step may an edge pass through a face.
#   tests/crossings.sh PROGRAM [TRIALS [SCENE..]]     TRIALS: of each (10: half an hour); SCENE: names below, or parts
program=$(realpath "$1") trials=${2:-10}
[ $# -lt 2 ] || shift
shift
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2

# The octopus with each face in four.
for flare in 0 10 30; do
    table=$here/../scenes/octopus_${flare}_magnetization.csv
    "$here"/finer_mesh.py "$here/../scenes/meshes/octopus_$flare.obj" octopus_$flare.obj \
        $([ -e "$table" ] && echo "$table" octopus_$flare.csv) || exit 2
done
finer_30="shell.mesh.file=$work/octopus_30.obj shell.magnetization.file=$work/octopus_30.csv"
finer_10="shell.mesh.file=$work/octopus_10.obj shell.magnetization.file=$work/octopus_10.csv shell.pose.file=$work/octopus_0.obj"

# name | scene | what is set. Without blanks within a value.
scenes() {
    cat <<LIST
fold, edges of 1 thickness | fold |
fold, of 1.7 | fold | shell.mesh.cells=[24,5]
fold, of 3 | fold | shell.mesh.cells=[14,3]
bud, edges of 1.5 thicknesses | bud |
bud, of 0.9 | bud | shell.mesh.n=15
bud, of 3 | bud | shell.mesh.n=4
drape, edges of 6 thicknesses | drape |
drape, of 9 | drape | shell.mesh.cells=[22,22]
drape, of 3 | drape | shell.mesh.cells=[66,66] time.steps=150
octopus, open water, edges of 2 thicknesses | octopus_open | design.iterations=0
octopus, open water, of 3 | octopus_open | design.iterations=0 shell.thickness=0.67e-3
octopus, open water, of 1 | octopus_open | design.iterations=0 $finer_30
octopus, pipe 1 | octopus_pipe1 | design.iterations=0
octopus, pipe 1, of 3 | octopus_pipe1 | design.iterations=0 shell.thickness=0.67e-3
octopus, pipe 1, of 1 | octopus_pipe1 | design.iterations=0 $finer_10
octopus, pipe 2 | octopus_pipe2 | design.iterations=0
octopus, tunnel | octopus_tunnel | design.iterations=0
gripper | gripper |
LIST
}

numbers() { # path: of the result that there is, one a line
    for group in history trajectory; do
        rm -f a.csv
        "$program" export a.vtkhdf -o a.csv --dataset $group/"$1" 2> /dev/null && grep -v '^#' a.csv && return
    done
}

speeds() { # seed: numbers that look random, of places
    awk -v seed="$1" 'BEGIN { srand(seed); q = "\""
        for (i = 0; i < 3; i++) printf "%s%s5e-4*sin(%.1f*x+%.1f*y+%.1f*z+%.3f)%s", i ? "," : "[", q, 2e4 * rand() - 1e4, 2e4 * rand() - 1e4, 2e4 * rand() - 1e4, 6 * rand(), q
        print "]" }'
}

bad=0
scenes > scenes.txt
while IFS='|' read -r name scene sets; do
    name=${name% } scene=$(echo $scene)
    [ -e "$here/../scenes/$scene.yaml" ] || continue
    wanted=$([ $# = 0 ] && echo yes; for part; do case $name in *$part*) echo yes ;; esac; done)
    [ -n "$wanted" ] || continue
    options=; for set in $sets; do options="$options --set $set"; done
    most=0 least=1 codes=
    for trial in $(seq "$trials"); do
        # shellcheck disable=SC2086
        "$program" run "$here/../scenes/$scene.yaml" $options --set "shell.velocity.formula=$(speeds "$trial")" \
            --quiet --no-picture --force -o a > said.txt 2>&1
        code=$?
        codes="$codes $code"
        [ $code -le 1 ] || head -1 said.txt
        most=$(numbers crossings | awk -v m="$most" '$1 > m { m = $1 } END { print NR ? m : "no number" }')
        least=$(numbers self_distance | awk -v m="$least" '$1 < m { m = $1 } END { print m }')
    done
    echo "$name: at most $most crossings, nearest $least m, exit codes$codes"
    [ "$most" = 0 ] || bad=1
done < scenes.txt
exit $bad
