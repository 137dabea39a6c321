#!/bin/sh
# Young's modulus from an outline, and what of a mesh's groups a result, an export and `check` say.    tests/targets.sh PROGRAM
. "$(dirname "$0")/expect.sh"
run() { "$program" run "$@" --quiet --no-picture; }
line() { sed -n "$1p" "$2"; }
is() { [ "$2" = "$3" ] || { echo "$1: '$2', not '$3'"; bad=1; }; }

# ---- A sagging strip seen from the side ----
expect 0 run "$here/../scenes/strip_outline.yaml" -o strip --set shell.mesh.n=16
expect 0 "$program" export strip.vtkhdf -o young.csv --dataset design/young
awk -F, '!/^#/ && ($1 < 0.81e6 || $1 > 0.85e6) {bad = 1} END {exit bad}' young.csv ||
    { echo "Young's modulus is not 0.83 MPa:"; line 2 young.csv; bad=1; }
expect 0 "$program" export strip.vtkhdf -o cloud.csv --dataset cases/case1/cloud
is "points of the cloud" "$(grep -vc '^#' cloud.csv)" 120

# ---- A rod's end, by its name or number; both conditions hold; a part of it on a cloud ----
cat > rod.yaml <<'END'
slender: 1
job: design
rod: {length: 100 mm, radius: 1 mm, young: 1 MPa, poisson: 0.5, density: 1100, natural_strain: [0, 0, 0], elements: 10}
flux_density: [0, 0, 10 mT]
target: {formula: ["0.09", "7", "0.02"], axes: xz, on: {group: tip}}
design: {unknowns: {magnetization: {noise: 100}}, objectives: [{target: 1}], iterations: 30}
END
expect 0 run rod.yaml -o tip
expect 0 "$program" export tip.vtkhdf -o tip.csv --dataset rod/x
tail -n 1 tip.csv | awk -F, '{exit ($1 - 0.09)^2 + ($3 - 0.02)^2 < 1e-7 ? 0 : 1}' || { echo "the end is not there:"; tail -n 1 tip.csv; bad=1; }
for on in '{group: "10"}' '{vertices: [10]}' '{vertices: [3, 10], group: tip}'; do
    expect 0 run rod.yaml -o other --force --set "target.on=$on"
    expect 0 "$program" export other.vtkhdf -o other.csv --dataset rod/x
    same tip.csv other.csv
done
printf '0.05, 0, 0.01\n' > cloud.csv
for on in all '{vertices: [4, 5, 6]}' '{vertices: [9, 10]}'; do
    expect 0 run rod.yaml -o cloud --force --set "target={cloud: cloud.csv, on: $on}" --set design.iterations=0 --set design.unknowns.magnetization.noise=0 --set rod.gravity=[0,0,0]
    expect 0 "$program" export cloud.vtkhdf -o f.csv --dataset history/objective
    tail -n 1 f.csv >> objectives.txt
done
awk '{d = $1 - (NR < 3 ? 1e-4 : 17e-4)} d*d > 1e-14 {bad = 1} END {exit bad || NR != 3}' objectives.txt || # the rod is straight
    { echo "a cloud of a part:"; cat objectives.txt; bad=1; }

# ---- Groups ----
cat > star.yaml <<'END'
slender: 1
job: evaluate
shell:
  mesh: {shape: hexagram, size: 40 mm, n: 1}
  thickness: 1 mm
  young: 1 MPa
  poisson: 0.3
  magnetization: {groups: {hub: [0, 0, -1.0e+4], flap2: {remanence: [30 mT, 30 mT, 0]}}, other: [0, 0, 0]}
END
expect 0 "$program" check star.yaml; says "groups of faces: hub (6), flap1 (1), flap2 (1), flap3 (1)"
run star.yaml -o star > run.txt 2>&1
expect 0 "$program" export star.vtkhdf -o star.csv --per group
is "rows" "$(wc -l < star.csv | tr -d ' ')" 3
is "hub" "$(line 2 star.csv)" "hub,6,10000,12.5664,0.0000,-90.0000,0.0000"
is "flap2" "$(line 3 star.csv)" "flap2,1,33761.9,42.4264,45.0000,0.0000,0.0000"
# Two of the hub's six faces are thrice as thick and thrice as magnetised: (2 3 3 + 4)/(2 3 + 4) = 2.2
run star.yaml -o uneven --set 'shell.thickness="y > 0 ? 0.003 : 0.001"' --set 'shell.magnetization=["y > 0 ? 3e4 : 1e4", "0", "0"]' > run.txt 2>&1
expect 0 "$program" export uneven.vtkhdf -o uneven.csv --per group
is "hub, by volume" "$(line 2 uneven.csv)" "hub,6,22000,27.646,0.0000,0.0000,0.0000,0.00166667"
# .. and two across the other four: the mean is nearer to these, the spread the angle to those.
run star.yaml -o across --set 'shell.magnetization=["y > 0 ? 1e4 : 0", "y > 0 ? 0 : 1e4", "0"]' > run.txt 2>&1
expect 0 "$program" export across.vtkhdf -o across.csv --per group
is "hub, spread" "$(line 2 across.csv)" "hub,6,7453.56,9.36642,63.4349,0.0000,63.4349"
expect 0 "$program" export star.vtkhdf -o star.obj
is "g lines" "$(grep -c '^g ' star.obj)" 7
sed 's/shape: hexagram, size: 40 mm, n: 1/file: star.obj/' star.yaml > again.yaml
expect 0 "$program" check again.yaml; says "groups of faces: hub (6), flap1 (1)"
cat > box.yaml <<'END'
slender: 1
job: evaluate
solid:
  mesh: {shape: box, size: [20 mm, 6 mm, 4 mm], cells: [2, 1, 1]}
  young: 1 MPa
  poisson: 0.3
  skin: {thickness: 1 mm, on: {group: top}, magnetization: [1 kA/m, 0, 0]}
END
expect 0 run box.yaml -o box
expect 0 "$program" export box.vtkhdf -o box.csv --per group # of the groups that have some of the top only its own has the layer
is "groups of a skin" "$(sed 1d box.csv)" "top,16,1000,1.25664,0.0000,0.0000,0.0000"
cat > wedge.msh << 'END'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
3
2 1 "layer"
2 2 "half"
3 3 "inside"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 0.01 0 0
3 0 0.01 0
4 0 0 0.01
$EndNodes
$Elements
4
1 2 2 1 1 1 2 3
2 2 2 2 2 1 2 3
3 2 2 2 2 1 2 4
4 4 2 3 3 1 2 3 4
$EndElements
END
expect 0 run box.yaml -o wedge --set solid.mesh=wedge.msh --set solid.skin.on=layer --set solid.order=1 --set solid.averaging=1
expect 0 "$program" export wedge.vtkhdf -o wedge.csv --per group
is "groups that share faces" "$(cut -d, -f1-3 wedge.csv | sed 1d | tr '\n' ' ')" "layer,1,1000 half,1,1000 "
expect 2 "$program" export star.vtkhdf -o x.csv --per face; says "--per must be group"
expect 2 "$program" export star.vtkhdf -o x.csv --per group --dataset rest; says "exclude each other"
expect 2 "$program" export star.vtkhdf -o x.obj --per group; says "per group is for a CSV"
run star.yaml -o plain --set 'shell.magnetization=[0, 0, 0]' > run.txt 2>&1
expect 3 "$program" export plain.vtkhdf -o x.csv --per group; says "nothing is magnetised"

# Thickness and Young's modulus have columns where they vary, of what is no magnet, too.
cat > made.yaml <<'END'
slender: 1
job: evaluate
shell: {mesh: {shape: hexagram, size: 40 mm, n: 2}, thickness: {groups: {hub: 2 mm}, other: 1 mm}, young: {groups: {flap1: 3 MPa}, other: 1 MPa}, poisson: 0.3}
END
expect 0 "$program" run made.yaml --quiet --no-picture
expect 0 "$program" export made.vtkhdf -o made.csv --per group
cat > wanted.csv <<'END'
hub,24,0,0,0.0000,0.0000,0.0000,0.002,1e+06
flap1,4,0,0,0.0000,0.0000,0.0000,0.001,3e+06
flap2,4,0,0,0.0000,0.0000,0.0000,0.001,1e+06
END
sed -n 1p made.csv | grep -q ',thickness \[m\],young \[Pa\]$' || { echo "no columns of thickness and young"; bad=1; }
sed -n 2,4p made.csv > first.csv; same first.csv wanted.csv
exit $bad
