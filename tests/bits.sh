#!/bin/sh
# For who changes the program and not its results: runs small scenes of every job and body with the program of the step
# before and with that of now, and compares what they leave byte for byte (tests/bits.py). A line for each scene; ends
# with 1 where anything differs, with 2 where it cannot compare. Two minutes on two cores, seven with --threads 1,2,5.
#   tests/bits.sh [--threads N,N..] OLD NEW [SCENE..]     SCENE: names below, or parts of them
# --threads 1,2,5 runs NEW with so many threads too, and compares each with NEW's first, which has one.
# Needs /usr/bin/python3 with h5py.
threads=
[ "$1" = --threads ] && { threads=$(echo "$2" | tr , ' '); shift 2; }
[ $# -ge 2 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0"; exit 2; }
old=$(realpath "$1") new=$(realpath "$2")
shift 2
here=$(cd "$(dirname "$0")" && pwd)
/usr/bin/python3 -c 'import h5py' 2> /dev/null || { echo "no h5py here (Debian: python3-h5py)"; exit 2; }
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT

# name | scene | what is set | what is set then, of a run that goes on with --resume. Without blanks within a value.
scenes() {
    cat <<'LIST'
shell_equilibrium | scenes/bending.yaml | shell.mesh.cells=[24,4]
shell_modes | scenes/cantilever.yaml | shell.mesh.n=12
shell_sequence | scenes/twisting.yaml | shell.mesh.cells=[12,2]
shell_hinge | scenes/cantilever.yaml | shell.mesh.n=10 shell.bending=hinge
shell_evaluate | scenes/banner.yaml | job=evaluate
shell_design | tests/scene_small.yaml | shell.mesh.n=5 design.iterations=6
shell_design_resumed | tests/scene_small.yaml | shell.mesh.n=5 design.iterations=3 | design.iterations=6
shell_design_mma | tests/scene_small.yaml | shell.mesh.n=5 design.optimizer=mma design.iterations=8
shell_design_lbfgs | tests/scene_small.yaml | shell.mesh.n=5 design.optimizer=lbfgs design.iterations=8
shell_design_fields | tests/scene_fields.yaml |
shell_design_fold | scenes/banner_letter.yaml | design.iterations=2
shell_thickness | scenes/strip_taper.yaml | shell.mesh.n=12 design.iterations=4
shell_design_height | scenes/kirigami_height.yaml | shell.mesh.n=5 design.iterations=8
shell_simulate | tests/scene_simulate.yaml | time.steps=40
shell_simulate_resumed | tests/scene_simulate.yaml | time.steps=20 | time.steps=40
shell_motion | scenes/hexagram_motion.yaml | time.steps=6 output.every=2
shell_vibration | scenes/strip_vibration.yaml | shell.mesh.n=12 time.steps=40
shell_trajectory | tests/scene_trajectory.yaml | design.iterations=3
shell_trajectory_resumed | tests/scene_trajectory.yaml | design.iterations=2 | design.iterations=3
shell_track | scenes/track_circle.yaml | shell.mesh.cells=[9,3] design.iterations=3
contact | tests/scene_contact.yaml |
contact_resumed | tests/scene_contact.yaml | time.steps=45 | time.steps=80
contact_implicit | tests/scene_contact.yaml | contact.coupling=implicit
contact_fold | scenes/fold.yaml | shell.mesh.cells=[16,4] time.steps=120
contact_bud | scenes/bud.yaml | shell.mesh.n=5 time.steps=60
contact_drape | scenes/drape.yaml | shell.mesh.cells=[12,12] time.steps=60
contact_reptile | scenes/reptile_bump.yaml | time.steps=60
contact_octopus | scenes/octopus_pipe1.yaml | design.iterations=1
solid_equilibrium | scenes/cook.yaml |
solid_evaluate | scenes/plate_layers.yaml | solid.mesh.cells=[12,8,2]
shell_pose | scenes/plate_shell.yaml | shell.mesh.cells=[12,8]
solid_heart | scenes/heart_band.yaml | design.iterations=2
solid_design | scenes/hand_fist.yaml | design.iterations=2
solid_trajectory | scenes/starfish_jump.yaml | solid.mesh.n=1 solid.order=1 design.iterations=1
solid_simulate | tests/scene_solid.yaml |
solid_simulate_resumed | tests/scene_solid.yaml | time.steps=40 | time.steps=80
rod_equilibrium | scenes/rod_equilibrium.yaml | rod.elements=200
rod_evaluate | scenes/rod_equilibrium.yaml | job=evaluate rod.elements=200
rod_cantilever | scenes/rod_cantilever.yaml | rod.elements=100
rod_arch | scenes/rod_arch.yaml | rod.elements=80
rod_twist | scenes/rod_twist.yaml | rod.elements=60
rod_clamped | scenes/rod_clamped.yaml | rod.elements=80
rod_helix | scenes/rod_helix.yaml |
rod_conical | scenes/rod_conical.yaml |
rod_ellipse | scenes/rod_ellipse.yaml | rod.elements=150
rod_framed | scenes/rod_framed.yaml | rod.elements=100
rod_held | scenes/rod_held.yaml | rod.elements=100
rod_framings | scenes/rod_framings.yaml | rod.elements=100
rod_knot | scenes/rod_knot.yaml | rod.elements=300
rod_samples | scenes/rod_samples.yaml |
rod_wave | scenes/rod_wave.yaml | rod.elements=200
rod_hair | scenes/rod_hair.yaml | rod.curve.strands=30
rod_identify | scenes/rod_identify.yaml | rod.elements=60
rod_fall | scenes/rod_fall.yaml | rod.elements=80 time.steps=40
rod_wave_pushed | scenes/rod_wave_pushed.yaml | rod.elements=80 time.steps=60
rod_simulate | tests/scene_rod_simulate.yaml | time.steps=60
rod_simulate_resumed | tests/scene_rod_simulate.yaml | time.steps=30 | time.steps=60
rod_tentacle | scenes/rod_tentacle.yaml |
rod_preview | scenes/rod_preview.yaml | time.steps=40
rod_design | tests/scene_rod_design.yaml | design.iterations=8
rod_design_resumed | tests/scene_rod_design.yaml | design.iterations=4 | design.iterations=8
rod_trajectory | tests/scene_rod_trajectory.yaml | design.iterations=3
rod_trajectory_resumed | tests/scene_rod_trajectory.yaml | design.iterations=2 | design.iterations=3
rod_design_mma | scenes/rod_magnet.yaml | design.iterations=12
drawing | tests/scene_draw.yaml |
drawing_crossed | scenes/spline_crossed.yaml | spline.page.size=[90mm,60mm]
drawing_wave | scenes/spline_wave.yaml | spline.page.size=[90mm,60mm]
drawing_monte_carlo | scenes/spline_linewise.yaml | spline.page.size=[90mm,90mm]
drawing_dynamics | tests/scene_draw.yaml | spline.method=dynamics
drawing_regions | scenes/spline_regions.yaml | spline.rounds=1 spline.iterations=60
drawing_cmyk | scenes/spline_cmyk.yaml | spline.page.size=[90mm,60mm] spline.page.margin=4mm
drawing_match | scenes/spline_night.yaml | spline.page.size=[90mm,60mm] spline.page.margin=4mm
drawing_plotter | scenes/spline_tones.yaml | spline.page.size=[90mm,60mm] output.gcode=a.gcode output.hpgl=a.hpgl
LIST
}

run() { # program, threads, scene, what is set, what is set then: in a folder of its own, which keeps exit codes too
    program=$1 count=$2 scene=$here/../$3 first=$4 then=$5
    start() {
        sets= ; for set in $1; do sets="$sets --set $set"; done
        # shellcheck disable=SC2086
        "$program" run "$scene" $sets --threads "$count" --quiet --no-picture -o a $2 > said.txt 2>&1
        echo $? >> codes.txt
    }
    start "$first" ""
    [ -z "$then" ] || start "$first $then" --resume
}

compare() { # name, two folders of results
    echo "$1: $(/usr/bin/python3 "$here/bits.py" "$2" "$3")" | tee -a "$work/lines.txt"
}

wanted() { # name: is it, or has it a part that was asked for
    [ -n "$only" ] || return 0
    for part in $only; do case $1 in *$part*) return 0 ;; esac; done
    return 1
}

only=$*
scenes > "$work/scenes.txt"
while IFS='|' read -r name scene first then; do
    name=${name% } scene=$(echo $scene)
    wanted "$name" || continue
    for side in old new $threads; do mkdir -p "$work/$name/$side"; done
    (cd "$work/$name/old" && run "$old" 1 "$scene" "$first" "$then") &
    (cd "$work/$name/new" && run "$new" 1 "$scene" "$first" "$then")
    wait
    compare "$name" "$work/$name/old" "$work/$name/new"
    for count in $threads; do
        (cd "$work/$name/$count" && run "$new" "$count" "$scene" "$first" "$then")
        compare "$name, $count threads" "$work/$name/new" "$work/$name/$count"
    done
    rm -rf "${work:?}/$name"
done < "$work/scenes.txt"
[ -s "$work/lines.txt" ] || { echo "no scene is called so: $only"; exit 2; }
! grep -qv ': same' "$work/lines.txt"
