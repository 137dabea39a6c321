#!/bin/sh
# Jobs that start from what another run left: the same bits as the undivided run, and what is refused.
#   tests/start.sh PROGRAM
. "$(dirname "$0")/expect.sh"
run() { # anew, whatever was left under that name
    case " $* " in *" --resume "* | *" --force "*) ;; *) set -- "$@" --force ;; esac
    "$program" run "$@" --quiet --no-picture
}
put() { "$program" export "$1.vtkhdf" -o "$2" --dataset "$3"; }
has() { "$program" info "$1.vtkhdf" | grep -q "^  $2 "; }

# The last states of two results, bit by bit.
alike() {
    for path in dofs velocities memory time anchor x; do
        has "$1" slender/state/$path || has "$2" slender/state/$path || continue
        put "$1" a.csv state/$path; put "$2" b.csv state/$path
        cmp -s a.csv b.csv || { echo "$scene: state/$path of $1 and $2 differ"; bad=1; }
    done
}
# Newton iterations, at most: of what starts where it is to go.
few() { [ "$(iterations | sort -n | tail -n 1)" -le 1 ] || { echo "$scene takes iterations: $(iterations)"; bad=1; }; }
# Are two results' state/x within so much of each other, m?
within() {
    put "$1" a.csv state/x; put "$2" b.csv state/x
    paste -d, a.csv b.csv | awk -F, -v d="$3" 'NR > 1 { for (i = 1; i <= 3; i++) { e = $i - $(i + 3); if (e > d || e < -d) bad = 1 } } END { exit bad }'
}
near() { within "$@" || { echo "$scene: $1 and $2 are more than $3 m apart"; bad=1; }; }
iterations() { sed -n 's/.* \([0-9]*\) Newton iterations.*/\1/p' out.txt; }

shell='{mesh: {shape: sheet, size: [30 mm, 10 mm], cells: [6, 2]}, thickness: 1 mm, young: 0.1 MPa, poisson: 0.5,
  density: 1000, magnetization: [50 kA/m, 0, 0], gravity: [0, 0, -9.81]}'
hinge=$(echo "$shell" | sed 's/young/bending: hinge, young/')
rod='{natural_strain: [1, 20, 3], length: 0.2, elements: 30, radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1100,
  magnetization: [20 kA/m, 0, 5 kA/m]}'
held=$(echo "$rod" | sed 's/magnet/end: {position: [0.1, 0.02, 0.05]}, magnet/')
swing=$(echo "$held" | sed 's/young/solver: pbd, young/')
stretching=$(echo "$held" | sed 's/young/model: cosserat, young/')
preview=$(echo "$rod" | sed 's/magnet.*/solver: pbd}/')
solid='{mesh: {shape: box, size: [20 mm, 5 mm, 5 mm], cells: [4, 1, 1]}, young: 0.1 MPa, poisson: 0.4, gravity: [0, 0, -9.81],
  skin: {thickness: 1 mm, magnetization: [50 kA/m, 0, 0], young: 0.2 MPa, poisson: 0.3}}'
linear=$(echo "$solid" | sed 's/1, 1]}/&, order: 1, averaging: 1/')
field='flux_density: ["0", "0.01*cos(100*t)", "0.02*sin(300*t)"]'
magnet='flux_density: {magnet: {at: [0.1, 0.1, 0], remanence: [0, 0, 1], volume: 1.0e-6}}'
fix='fix: [{group: root, clamp: true}]'
write() { # name, job, body, further keys
    { echo "slender: 1"; echo "job: $2"; shift 2; printf '%s\n' "$@"; } > "$scene"
}

# ---- Motions cut in two, and in ten ----
motion() { # scene's name, body, further keys
    scene=$1.yaml; shift
    write "$scene" simulate "$@" "time: {step: 1 ms, steps: 40}"
    expect 0 run "$scene" -o whole
    expect 0 run "$scene" -o before --set time.steps=10
    expect 0 run "$scene" -o after --set time.steps=30 --set start=before.vtkhdf; alike whole after
    expect 0 run "$scene" -o before --set time.steps=4
    for k in 2 3 4 5 6 7 8 9 10; do
        expect 0 run "$scene" -o after --set time.steps=4 --set start=before.vtkhdf
        mv after.vtkhdf before.vtkhdf; rm after.*
    done
    alike whole before
}
motion midedge "shell: $shell" "$fix" "$field"
motion hinge "shell: $hinge" "$fix" "$field"
motion solid "solid: $solid" "fix: [{group: left}]" "$field"
motion linear "solid: $linear" "$field"
motion rod "rod: $rod" "$field"
motion held "rod: $held" "$field"
motion magnet "rod: $rod" "$magnet"
motion stretching "rod: $stretching" "$field"
motion preview "rod: $preview"
motion swing "rod: $swing" "$field"

# ---- Frames, and runs that are resumed ----
scene=midedge.yaml
expect 0 run midedge.yaml -o whole
for body in midedge preview; do
    scene=$body.yaml
    expect 0 run $scene -o all --set "output={states: all, every: 5}" --set time.steps=20
    expect 0 run $scene -o all --set "output={states: all, every: 5}" --resume # extended: frames come back
    expect 0 run $scene -o once --set "output={states: all, every: 5}"
    for path in frames/dofs frames/time VTKHDF/Points; do put all a.csv $path; put once b.csv $path; same a.csv b.csv; done
    expect 0 run $scene -o after --set "start={result: all.vtkhdf, frame: 3}" --set time.steps=25; alike once after
done

scene=midedge.yaml
expect 0 run $scene -o first --set time.steps=10
expect 0 run $scene -o after --set start=first.vtkhdf --set time.steps=15
expect 0 run $scene -o after --set start=first.vtkhdf --set time.steps=30 --resume; alike whole after
mv first.vtkhdf moved.vtkhdf
expect 0 run $scene -o after --set start=moved.vtkhdf --set time.steps=32 --resume
expect 0 run $scene -o first --set time.steps=9
expect 3 run $scene -o after --set start=first.vtkhdf --set time.steps=35 --resume; says "first.vtkhdf is not the file that the run began with"
expect 4 run $scene -o first --set start=first.vtkhdf --force; says "the scene is made of it"

# ---- Equilibria ----
scene=rest.yaml
write rest equilibrium "shell: $shell" "$fix" "flux_density: [0, 0, 5 mT]"
rest() { expect 0 "$program" run "$scene" --no-picture --force "$@"; }
rest -o rest; rest -o again --set start=rest.vtkhdf
few
rest -o moving --set start=rest.vtkhdf --set job=simulate --set "time={step: 1 ms, steps: 5}" # what rests stays
near rest again 1e-12; near rest moving 1e-12
scene=block.yaml
write block equilibrium "solid: $solid" "fix: [{group: left}]" "flux_density: [0, 0, 5 mT]"
rest -o rest; rest -o again --set start=rest.vtkhdf
few
rest -o moving --set start=rest.vtkhdf --set job=simulate --set "time={step: 1 ms, steps: 5}"
near rest again 1e-12; near rest moving 1e-12
scene=turned.yaml
write turned equilibrium "rod: $rod" "flux_density: [0, 3 mT, 2 mT]" # in turns only; a motion has places, too
rest -o rest; rest -o moving --set start=rest.vtkhdf --set job=simulate --set "time={step: 1 ms, steps: 5}"
rest -o again --set start=moving.vtkhdf
few

# A sequence that is continued follows the branch of the undivided one.
scene=stages.yaml
write stages equilibrium "rod: $rod"
one='{flux_density: [0, 3 mT, 2 mT], time: 1 s}' two='{flux_density: [0, 5 mT, -4 mT], time: 2 s}' three='{flux_density: [0, 5 mT, -9 mT], gravity: [0, 0, 0], time: 3 s}'
rest -o whole --set "sequence=[$one, $two, $three]"; rest -o before --set "sequence=[$one, $two]"
rest -o after --set "sequence=[$three]" --set start=before.vtkhdf; alike whole after

# Cases start from those of their names.
scene=cases.yaml
write cases equilibrium "shell: $shell" "$fix"
up='{name: up, flux_density: [0, 0, 9 mT]}' down='{name: down, flux_density: [0, 0, -9 mT]}'
rest -o both --set "cases=[$up, $down]"; rest -o again --set "cases=[$down, $up]" --set start=both.vtkhdf
few
rest -o again --set "flux_density=[0, 0, 9 mT]" --set "start={result: both.vtkhdf, case: up}"
few
rest -o again --set "flux_density=[0, 0, 9 mT]" --set "start={result: both.vtkhdf, frame: 1}" # the last one: down
[ "$(iterations)" -gt 1 ] || { echo "frame 1 is not the case 'down'"; bad=1; }
expect 3 run $scene -o x --set "start={result: both.vtkhdf, case: left}"; says "both.vtkhdf has no load case 'left'; it has up, down"
expect 3 run $scene -o x --set "start={result: both.vtkhdf, frame: 0}"; says "keeps the whole state of its last frame only, which is 1: run its scene with output.states: all"
expect 3 run $scene -o x --set "start={result: both.vtkhdf, frame: 2}"; says "has 2 frames, from 0 on"
expect 3 run $scene -o x --set "start={result: both.vtkhdf, frame: 1, case: up}"; says "a frame is one state"

# ---- What has met itself, or will ----
free='rod: {natural_strain: [0, 4, 0], length: 0.2, elements: 30, radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1100}'
for body in "shell: $shell" "$free"; do
    scene=meets.yaml
    write meets simulate "$body" "time: {step: 1 ms, steps: 5}"
    expect 0 run $scene -o alone
    for contact in "{self: true}" "{self: true, friction: 0.3}"; do
        expect 0 run $scene -o first --set contact="$contact"
        expect 0 run $scene -o after --set start=first.vtkhdf
        expect 0 run $scene -o again --set start=alone.vtkhdf --set contact="$contact"; near after again 1e-12
        expect 0 run $scene -o again --set start=first.vtkhdf --set "contact={self: true}"
    done
done

# ---- Designs ----
scene="$here/scene_small.yaml --set shell.mesh.n=2 --set design.iterations=0"
first() { put "$1" n.csv history/newton_iterations; sed -n 2p n.csv; }
# shellcheck disable=SC2086
{
    expect 0 run $scene -o design
    expect 0 run $scene -o again --set start="$work/design.vtkhdf"
}
[ "$(first again)" -le 4 ] || { echo "a design's cases do not start from their own: $(first again) iterations"; bad=1; }

# A trajectory goes on as the simulation does, to the solver's tolerance; and a simulation from it.
scene=midedge.yaml
expect 0 run $scene -o whole --set time.steps=20
expect 0 run $scene -o before --set time.steps=10
design='design={unknowns: {young: {bounds: [1.0e4, 1.0e6]}}, objectives: [{waypoint: {vertex: tip, at: [0, 0, 0]}}], iterations: 0}'
expect 0 run $scene -o path --set job=trajectory --set "$design" --set start=before.vtkhdf --set time.steps=5
expect 0 run $scene -o after --set start=path.vtkhdf --set time.steps=5
near whole after 1e-9

# ---- Places and velocities from files ----
scene=midedge.yaml
faster() { sed "s/, thickness/, velocity: $1, thickness/; s/, length: 0.2/, length: 0.2, velocity: $1/" $scene > fast.yaml; }
for kind in "midedge.yaml 21" "rod.yaml 31"; do # with so many points
    scene=${kind% *}
    seq "${kind#* }" | sed 's/.*/0, 0.1, -0.2/' > v.csv
    faster '[0, 0.1, -0.2]'; expect 0 run fast.yaml -o whole --set time.steps=3
    faster '{file: v.csv}'; expect 0 run fast.yaml -o after --set time.steps=3; alike whole after
done
scene=nodes.yaml # a rod in the shape of a polyline that it rested in stays there; let go in its natural shape it falls
write nodes equilibrium "rod: {natural_strain: [0, 20, 0], length: 0.2, elements: 100, radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1100}"
rest -o rest; put rest nodes.csv rod/x
sed 's/length: 0.2/curve: {file: nodes.csv, noise: 0}, bishop_normal: [0, 1, 0]/' nodes.yaml > let.yaml
for start in curve natural; do
    expect 0 run let.yaml -o $start --set rod.start=$start --set job=simulate --set "time={step: 1 ms, steps: 20}"
done
near rest curve 2e-4
! within rest natural 5e-2 || { echo "the rod does not fall"; bad=1; }

# ---- What is refused ----
scene=midedge.yaml
refused() { # sentence, keys
    what=$1; shift
    expect 3 run "$scene" -o x "$@"; says "$what"
}
refused "cannot be read" --set start=none.vtkhdf
refused "midedge.yaml is no result of slender" --set start=midedge.yaml
refused "is of a mesh with other faces" --set start=before.vtkhdf --set shell.mesh.cells=[5,2]
refused "is of a mesh of another shape at rest" --set start=before.vtkhdf --set "shell.mesh.size=[31 mm, 10 mm]"
refused "time.at: a simulation goes on from the time of its start, 0.01 s: leave .at. out" --set start=before.vtkhdf --set time.at=1
scene=solid.yaml
expect 0 run solid.yaml -o solid --set time.steps=2
refused "is of a mesh with other tetrahedra" --set start=solid.vtkhdf --set "solid.mesh.cells=[3, 1, 1]"
refused "is of a mesh with other tetrahedra" --set start=solid.vtkhdf --set solid.order=1
refused "is of a mesh of another shape at rest" --set start=solid.vtkhdf --set "solid.mesh.size=[20 mm, 5 mm, 6 mm]"
"$program" mesh solid.yaml -o pose.obj
expect 0 run solid.yaml -o posed --set solid.pose=pose.obj --set time.steps=2
sed 's/^v 0 /v 1.0e-5 /' pose.obj > other.obj; mv other.obj pose.obj
expect 3 run solid.yaml -o posed --set solid.pose=pose.obj --set time.steps=3 --resume; says "pose.obj is not the file that the run began with"
refused "solid.pose is not used" --set start=solid.vtkhdf --set solid.pose=pose.obj
scene=rod.yaml
refused "before.vtkhdf is a result of a shell, and the scene has a rod" --set start=before.vtkhdf
expect 0 run rod.yaml -o before --set time.steps=2; cp before.vtkhdf rod.vtkhdf
refused "is of a rod of another length, or of other elements" --set start=rod.vtkhdf --set rod.elements=29
refused "its first end is elsewhere" --set start=rod.vtkhdf --set "rod.clamp.position=[0, 0, 1]"
refused "its other end is not where rod.end holds it" --set start=rod.vtkhdf --set "rod.end={position: [0.1, 0, 0]}"
expect 0 run stretching.yaml -o before --set time.steps=2; scene=held.yaml
refused "its rod stretches: only model: cosserat goes on from it" --set start=before.vtkhdf; scene=rod.yaml
expect 0 run preview.yaml -o before --set time.steps=2
refused "is that of .solver: pbd., from which only that goes on" --set start=before.vtkhdf
scene=preview.yaml
refused "is not that of .solver: pbd., which goes on from its own only" --set start=rod.vtkhdf
expect 0 run swing.yaml -o before --set time.steps=2; scene=swing.yaml
refused "its other end is not where rod.end holds it" --set start=before.vtkhdf --set "rod.end.position=[0.1, 0, 0.05]"
cat > invert.yaml <<'END'
slender: 1
job: invert
rod: {curve: {formula: ["0.1*sin(u)", "0", "0.1*cos(u)"], range: [0, 1]}, radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1100, elements: 20}
END
expect 0 run invert.yaml -o inverse
refused "has no state to start from" --set start=inverse.vtkhdf
# ---- What something has gone through is told by how the run ended, not by its state ----
cat > thrown.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: {shape: sheet, size: [10 mm, 10 mm], cells: [10, 10], pattern: alternate}, thickness: 0.2 mm, young: 0.2 MPa, poisson: 0.3, velocity: [0, 0, -100]}
obstacles: [{sphere: {center: [5.3 mm, 4.8 mm, -2.3 mm], radius: 0.5 mm}}]
time: {step: 1 ms, steps: 1}
END
expect 1 run thrown.yaml -o thrown
sed 's/, velocity: [^}]*//; $a start: {result: thrown.vtkhdf}' thrown.yaml > onward.yaml
expect 0 "$program" check onward.yaml; says "warning: start.result: .*thrown.vtkhdf ended as pierced, and what starts from it has that in it"
exit $bad
