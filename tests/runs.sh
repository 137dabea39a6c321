#!/bin/sh
# What a run is, to a later one: what --resume accepts and refuses, what it leaves of an older end, and what statuses
# say.    tests/runs.sh PROGRAM
. "$(dirname "$0")/expect.sh"
run() { "$program" run "$@" --quiet --no-picture; }
status() { "$program" info "$1" | sed -n '1s/^[^:]*: \([a-z_]*\),.*/\1/p'; }
is() { [ "$2" = "$3" ] || { echo "$1: '$2', not '$3'"; bad=1; }; }
datasets() { "$program" info "$1" | sed -n 's/^  \([^ ]*\) .*/\1/p'; }

# ---- A pose without finite forces, in any of the cases, is a failure ----
cat > pose.yaml <<'END'
slender: 1
job: evaluate
rod: {length: 100 mm, radius: 1 mm, young: 1 MPa, poisson: 0.5, density: 1100, elements: 5, natural_strain: [0, 0, 0], magnetization: [1e4, 0, 0]}
cases: [{name: first, flux_density: ["1/x", "0", "0"]}, {name: second, flux_density: [0, 0, 1 mT]}]
END
expect 1 run pose.yaml -o pose; expect 0 "$program" info pose.vtkhdf; says "not_finite"

# A body at rest that nothing acts on is in balance, but for rounding.
for body in "shell: {mesh: {shape: strip, size: [40 mm, 10 mm], n: 4}, thickness: 1 mm" "solid: {mesh: {shape: box, size: [20 mm, 6 mm, 4 mm], cells: [2, 1, 1]}"; do
    printf 'slender: 1\njob: evaluate\n%s, young: 1 MPa, poisson: 0.3}\nfix: [{vertices: [0, 1, 2, 3, 4, 5]}]\n' "$body" > still.yaml
    expect 0 "$program" run still.yaml --no-picture --force; says "case1: an equilibrium, stable"
done

# ---- The result of an earlier run ----
# The same scene may be run again; another one, or one of other files, is refused, and neither result nor journal is lost.
cat > earlier.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: {shape: sheet, size: [20 mm, 10 mm], cells: [2, 1]}, thickness: 1 mm, young: {file: young.csv}, poisson: 0.3, density: 1000}
fix: [{group: root, clamp: true}]
time: {step: 1 ms, steps: 2}
END
young() { printf '%s\n' "$1" "$1" "$1" "$1" > young.csv; } # of four faces
young 1e6
expect 0 run earlier.yaml -o e
expect 0 run earlier.yaml -o e
cp e.vtkhdf e.copy; cp e.run e.journal
expect 4 run earlier.yaml -o e --set shell.thickness=2mm; says "e.vtkhdf: it is the result of another scene: shell.thickness.value is not the same; give another name with -o, replace it with --force$"
expect 4 run earlier.yaml -o e --set time.steps=3; says "time.steps is not the same; .* or go on with it with --resume$"
young 2e6
expect 4 run earlier.yaml -o e; says "shell.young.file: .*young.csv is not the file that the run began with"
mv e.run away.run; expect 4 run earlier.yaml -o e --set shell.thickness=2mm; says "the result of another scene"; mv away.run e.run
same e.vtkhdf e.copy; same e.run e.journal
expect 0 run earlier.yaml -o e --force
young 1e6
expect 0 run earlier.yaml -o e --force; same e.vtkhdf e.copy
# Files beside a result go with it; without one they are somebody else's, unless a journal tells that they are the run's.
probed="earlier.yaml -o own --set probes.tip.group=tip"
for file in own.png own_probes.csv own.xdmf; do
    [ $file = own.png ] && whose="slender has not made it" || whose="no 'own.vtkhdf' that it would belong to"
    echo mine > $file
    # shellcheck disable=SC2086
    expect 4 "$program" run $probed --quiet; says "'$file' is there, and $whose: give another name, or replace it with --force$"
    is "$file" "$(cat $file)" mine
    [ ! -e own.run ] || { echo "a refused run leaves its journal"; bad=1; }
    rm $file
done
echo mine > own.png
# shellcheck disable=SC2086
{
    expect 0 run $probed; is "a run without a picture" "$(cat own.png)" mine
    rm own.vtkhdf own.run own_probes.csv own.xdmf
    expect 0 "$program" run $probed --quiet --force; expect 0 "$program" run $probed --quiet; grep -q PNG own.png || { echo "own.png is no picture"; bad=1; }
    cp own.png ours.png; cp own.run own.journal; echo mine > own.png
    expect 4 "$program" run $probed --quiet; says "'own.png' is there, and slender has not made it: give another name, or replace it with --force$"
    expect 4 "$program" run $probed --quiet --resume; says "'own.png' is there, and slender has not made it: move it, then go on with --resume$"
    is "a picture that is not slender's" "$(cat own.png)" mine; same own.run own.journal
    expect 0 "$program" run $probed --quiet --force; same own.png ours.png
    rm own.vtkhdf own.run own_probes.csv own.xdmf
    expect 4 "$program" run $probed --quiet; says "'own.png' is there, and no 'own.vtkhdf'"; same own.png ours.png
    expect 0 "$program" run $probed --quiet --force
    rm own.vtkhdf; expect 0 "$program" run $probed --quiet
}
expect 0 run earlier.yaml -o own --force; [ ! -e own_probes.csv ] || { echo "the table of probes of another run stays"; bad=1; }
echo mine > own_probes.csv; expect 0 run earlier.yaml -o own --force; is "a table that no run made" "$(cat own_probes.csv)" mine
mkdir elsewhere; cp earlier.yaml young.csv elsewhere
expect 0 run elsewhere/earlier.yaml -o e # by what is in the files, not by where they are
echo "no result" > f.vtkhdf
expect 4 run earlier.yaml -o f; says "f.vtkhdf is no result of slender.*; with --force it is replaced"
[ "$(cat f.vtkhdf)" = "no result" ] || { echo "a file of another kind is lost"; bad=1; }
expect 0 run earlier.yaml -o f --force

# ---- What journals are said to hold ----
expect 0 "$program" info e.run; says "e.run: finished, 2 steps, 0 frames, [0-9]* states*; the frames are in the result"; says "t 0.001 s  [0-9]* Newton iterations*  [0-9]* factorizations*$"
cat > preview.yaml <<'END'
slender: 1
job: simulate
rod: {natural_strain: [0, 20, 0], length: 0.2, elements: 5, radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1100, solver: pbd}
time: {step: 5 ms, steps: 2}
END
expect 0 run preview.yaml
expect 0 "$program" info preview.run; says "1  t 0.005 s$" # it has no iterations
sed '/^time/d; s/simulate/equilibrium/; s/, solver: pbd//' preview.yaml > rests.yaml
expect 0 run rests.yaml
expect 0 "$program" info rests.run; says "rests.run: finished, 1 frame, 1 state$"
expect 0 "$program" info rests.vtkhdf; says "converged, 1 frame$"; says "slender/rod/s  *real "

# ---- Input files ----
sheet() { # how far one vertex is from its place
    printf 'v 0 0 0\nv %s 0 0\nv 0.02 0 0\nv 0 0.01 0\nv 0.01 0.01 0\nv 0.02 0.01 0\nf 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\n' "$1"
}
mkdir cluster; cd cluster || exit 2
sheet 0.01 > sheet.obj
printf '0,0,1e4\n0,0,1e4\n0,0,1e4\n0,0,1e4\n' > m.csv
cat > scene.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: sheet.obj, thickness: 1 mm, young: 1 MPa, poisson: 0.3, density: 1000, magnetization: {file: m.csv}}
fix: [{vertices: [0, 3], clamp: true}]
flux_density: [20 mT, 0, 0]
time: {step: 1 ms, steps: 4}
END
expect 0 run scene.yaml -o r
cp r.vtkhdf first.vtkhdf
sheet 0.011 > sheet.obj
expect 3 run scene.yaml -o r --resume --set time.steps=8; says "shell.mesh.file: .*sheet.obj is not the file that the run began with"
same r.vtkhdf first.vtkhdf
sheet 0.01 > sheet.obj
printf '0,0,1e4\n0,0,1e4\n0,0,1e4\n0,0,2e4\n' > m.csv
expect 3 run scene.yaml -o r --resume --set time.steps=8; says "shell.magnetization.file"
printf '0,0,1e4\n0,0,1e4\n0,0,1e4\n0,0,1e4\n' > m.csv
cd .. && mv cluster laptop && cd laptop || exit 2
mv m.csv renamed.csv
expect 0 run scene.yaml -o r --resume --set time.steps=8 --set shell.magnetization.file=renamed.csv
mv renamed.csv m.csv
expect 0 run scene.yaml -o whole --set time.steps=8
for path in frames/flux_density VTKHDF/Points state/x history/time; do
    "$program" export whole.vtkhdf -o a.csv --dataset $path; "$program" export r.vtkhdf -o b.csv --dataset $path
    same a.csv b.csv
done

# ---- The result that frames are taken back from ----
expect 0 run scene.yaml -o other --set time.steps=8 --set shell.young=2e6
for foreign in other first; do # of another run, and an older one of the same run
    cp r.vtkhdf mine.vtkhdf; cp $foreign.vtkhdf r.vtkhdf
    expect 3 run scene.yaml -o r --resume --set time.steps=12; says "r.vtkhdf is not the result that this run has written"
    same r.vtkhdf $foreign.vtkhdf
    mv mine.vtkhdf r.vtkhdf
done
expect 3 run scene.yaml -o r --resume --set time.steps=12 --set output.precision=double; says "in single precision"
mv r.vtkhdf away; expect 3 run scene.yaml -o r --resume --set time.steps=12; says "r.vtkhdf: cannot be"; mv away r.vtkhdf
expect 0 run scene.yaml -o r --resume --set time.steps=12
cd "$work" || exit 2

# ---- Journals where nothing may be written ----
if [ "$(id -u)" = 0 ] && command -v setpriv > /dev/null; then
    chmod 755 "$work" laptop; chmod 644 laptop/r.run
    expect 0 setpriv --reuid 65534 --regid 65534 --clear-groups "$program" info laptop/r.run; says "finished"
fi
ls laptop > before.txt; "$program" info laptop/r.run > out.txt; ls laptop > after.txt; same before.txt after.txt

# ---- Ends ----
# A design that is extended has nothing of its first end: after one evaluation the motion's end is a saddle with a mode.
design="$here/scene_trajectory.yaml --set design.optimizer=lbfgs --set shell.mesh.cells=[5,2]"
# shellcheck disable=SC2086
{
    expect 0 run $design --set design.iterations=6 -o straight
    expect 0 run $design --set design.iterations=1 -o halves
    datasets halves.vtkhdf | grep -q final/modes || { echo "the first end has no mode: the test tests nothing"; bad=1; }
    expect 0 run $design --set design.iterations=6 -o halves --resume
}
datasets straight.vtkhdf > a.txt; datasets halves.vtkhdf > b.txt; same a.txt b.txt

# Statuses say what has happened.
is "limit" "$(status straight.vtkhdf)" max_iterations
hexagram="$here/scene_small.yaml --set shell.mesh.n=2"
# shellcheck disable=SC2086
for optimizer in gauss_newton lbfgs mma; do
    expect 0 run $hexagram --set design.optimizer=$optimizer --set design.iterations=2 -o h --force
    is "$optimizer, 2 iterations" "$(status h.vtkhdf)" max_iterations
    expect 0 run $hexagram --set design.optimizer=$optimizer --set design.iterations=0 -o h --force
    is "$optimizer, none" "$(status h.vtkhdf)" evaluated
    expect 0 run $hexagram --set design.optimizer=$optimizer --set design.tolerance=0.9 -o h --force
    is "$optimizer, nine tenths of the gradient" "$(status h.vtkhdf)" converged
    expect 1 run $hexagram --set design.optimizer=$optimizer --set design.unknowns.magnetization.noise=0 \
        --set "cases[0].flux_density=[0,0,0]" --set "cases[1].flux_density=[0,0,0]" -o h --force
    is "$optimizer, nothing acts" "$(status h.vtkhdf)" stationary
done
# shellcheck disable=SC2086
{
    expect 1 "$program" run $hexagram --set "cases[0].flux_density=[0,0,0]" --set "cases[1].flux_density=[0,0,0]" --no-picture -o h --force
    says "the gradient is zero at the start: either no unknown (magnetization)"; says "noise"
    says "warning: the unknown magnetization moves nothing: there is no .flux_density."
    expect 0 "$program" run $hexagram --set design.iterations=1 --no-picture -o h --force
    says "stopped at design.iterations = 1, not yet converged"
}
cat > idle.yaml <<'END'
slender: 1
job: design
shell: {mesh: {shape: strip, size: [20 mm, 5 mm], n: 4}, thickness: 0.5 mm, young: 0.1 MPa, poisson: 0.3}
fix: [{group: root, clamp: true}]
flux_density: [0, 0, 20 mT]
target: ["x", "y", "10*x^2"]
design: {unknowns: {magnetization: {scale: 1.0e+4}, young: {bounds: [1 kPa, 1 MPa]}}, objectives: [{target: 1}], iterations: 1}
END
expect 0 "$program" run idle.yaml --no-picture; says "the unknown young does not act on the objective at the start"

# A design of few numbers says them, and how far it is off: the root of F over the points.
expect 0 "$program" run "$here/../scenes/strip_outline.yaml" --no-picture -o few --set shell.mesh.n=8; says "^found: young 8[0-9.]*e+05 Pa$"
awk '/^converged/ {F = $6} /off the target/ {rms = $2; n = $(NF - 1)} END {exit !(n == 120 && (rms/sqrt(F/n) - 1)^2 < 1e-4)}' FS='[ ,]+' out.txt || { echo "not the root of F/n:"; cat out.txt; bad=1; }

# A pose in which forces are no numbers is said to be one, whatever the body.
flux='flux_density: {formula: ["0", "0", "0.01*log(0.02 - x)"]}'
cat > nowhere_rod.yaml <<END
slender: 1
job: evaluate
rod: {natural_strain: [0, 0, 0], length: 50 mm, radius: 1 mm, young: 1 MPa, poisson: 0.4, density: 1000, magnetization: [1.0e+4, 0, 0], elements: 10}
$flux
END
cat > nowhere_shell.yaml <<END
slender: 1
job: evaluate
shell: {mesh: {shape: strip, size: [40 mm, 5 mm], n: 4}, thickness: 0.5 mm, young: 0.1 MPa, poisson: 0.3, magnetization: [1.0e+4, 0, 0]}
$flux
END
for body in rod shell; do
    expect 1 "$program" run nowhere_$body.yaml --no-picture; says "is not a finite number at x = 0.02"
    is "$body, forces that are no numbers" "$(status nowhere_$body.vtkhdf)" not_finite
    says "a field has no value where the body is or would go"
    expect 0 "$program" check nowhere_$body.yaml; says "warning: case1: at the start flux_density: .* is not a finite number at x = 0.02"
done
# A strip that bends out of a map: the end says why, and not how many iterations.
for x in -5 20 45; do for y in -20 0 20; do for z in -3 0 3; do echo "$x.0e-3, $y.0e-3, $z.0e-3, 0, 0, 0.05"; done; done; done > map.csv
sed '/^flux/d; s/evaluate/equilibrium/' nowhere_shell.yaml > beyond.yaml
printf '%s\n' 'flux_density: {map: {file: map.csv}}' 'fix: [{group: root, clamp: true}]' 'solver: {max_iterations: 20}' >> beyond.yaml
expect 1 "$program" run beyond.yaml --no-picture; says "is beyond the map (beyond.yaml:4"; says "a field has no value where the body is or would go"

# A formula of time that is no number is a scene that is refused, whenever that shows.
cat > formula.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: {shape: strip, size: [20 mm, 5 mm], n: 4}, thickness: 1 mm, young: 1 MPa, poisson: 0.3, density: 1000}
fix: [{group: root, clamp: true}]
flux_density: ["sqrt(0.0025 - t)", "0", "0"]
time: {step: 1 ms, steps: 4}
END
expect 3 run formula.yaml; says 'flux_density: "sqrt(0.0025 - t)" is not a finite number at x = 0, .* (formula.yaml:5:15)$'
for job in equilibrium simulate; do # what moves, too
    sed "s/simulate/$job/; /^flux/d; s/^fix.*/fix: [{group: root, clamp: true}, {group: tip, move: [\"x\", \"y\", \"z + sqrt(x - 1)\"]}]/" formula.yaml > moved.yaml
    [ $job = simulate ] || sed -i '/^time/d' moved.yaml
    "$program" run moved.yaml --no-picture --force > out.txt 2> err.txt && { echo "a move that is no number is one"; bad=1; }
    says 'fix\[1\].move: "z + sqrt(x - 1)" is not a finite number at x = 0.02, .* (moved.yaml:4:54)$'
done
sed '/flux_density/d' formula.yaml > pole.yaml
echo 'obstacles: [{name: lid, plane: {point: [0, 0, -1]}, move: ["1/(0.002 - t)", "0", "0"]}]' >> pole.yaml
expect 3 run pole.yaml --set time.steps=3; says "obstacle 'lid': move: .* is not a finite number at t = 0.002 (pole.yaml:6:13)\$"

# Of a place, it is a solve that fails, and the field is named.
sed 's/flux_density.*/water: {velocity: ["sqrt(0.019 - x)", "0", "0"]}/; /^fix/d' formula.yaml > place.yaml
sed -i 's/density: 1000/density: 1000, velocity: [0.3, 0, 0]/' place.yaml
expect 1 "$program" run place.yaml --no-picture --force; says 'case1: water.velocity: "sqrt(0.019 - x)" is not a finite number at x = '
sed 's/^flux_density.*/flux_density: ["sqrt(0.01 - x)", "0", "0"]/; s/simulate/equilibrium/; /^time/d' formula.yaml > place.yaml
sed -i 's/density: 1000/magnetization: [1.0e+4, 0, 0]/' place.yaml
expect 1 "$program" run place.yaml --no-picture --force; says 'case1: flux_density: "sqrt(0.01 - x)" is not a finite number at x = '

# ---- Names of cases ----
name=$(printf '%0240d' 0)
two_cases() { # their names
    cat <<END
slender: 1
job: equilibrium
shell: {mesh: {shape: strip, size: [20 mm, 5 mm], n: 4}, thickness: 1 mm, young: 1 MPa, poisson: 0.3}
fix: [{group: root, clamp: true}]
cases: [{name: $1, gravity: [0, 0, -9.81]}, {name: $2, gravity: [0, 0, 9.81]}]
END
}
two_cases "a${name}b" "a${name}c" > names.yaml
expect 0 run names.yaml
is "cases of names that begin alike" "$(datasets names.vtkhdf | grep -c 'cases/.*/status')" 2
for wrong in . a/b "a$(printf '%0250d' 0)" '"a\tb"'; do
    two_cases "$wrong" b > wrong.yaml
    expect 3 run wrong.yaml; says "a case's name is a word without"
done

# ---- Vertices that are in no face, and such as are joined ----
cat > loose.obj <<'END'
v 9 9 9
v 0 0 0
v 0.02 0 0
v 0.04 0 0
v 0 0.01 0
v 0.02 0.01 0
v 0.04 0.01 0
v 0.02 0 0
v 0.02 0.01 0
f 2 3 6
f 2 6 5
f 8 4 7
f 8 7 9
END
cat > loose.yaml <<'END'
slender: 1
job: equilibrium
shell: {mesh: {file: loose.obj, weld: 1 um}, thickness: 1 mm, young: 1 MPa, poisson: 0.3, gravity: [0, 0, -9.81], fold: {formula: "1 + 10*x"}}
fix: [{vertices: [1, 4], clamp: true}]
END
expect 0 run loose.yaml
"$program" export loose.vtkhdf -o pose.obj
"$program" export loose.vtkhdf -o edges.csv --dataset edges; "$program" export loose.vtkhdf -o fold.csv --dataset design/fold
grep -v '#' edges.csv > e.txt; grep -v '#' fold.csv > k.txt; paste -d, e.txt k.txt > folds.csv
"$program" export loose.vtkhdf -o v.csv --dataset file_vertex; is "vertices of the file" "$(grep -v '#' v.csv | tr '\n' ' ')" "1 2 3 4 5 6 "
sed 's/fold: {.*}}/fold: {file: folds.csv}, pose: pose.obj}/' loose.yaml > again.yaml
expect 0 run again.yaml
for path in design/fold edges; do
    "$program" export loose.vtkhdf -o a.csv --dataset $path; "$program" export again.vtkhdf -o b.csv --dataset $path; same a.csv b.csv
done
exit $bad
