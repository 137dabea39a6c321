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
is "hub, by volume" "$(line 2 uneven.csv)" "hub,6,22000,27.646,0.0000,0.0000,0.0000"
expect 0 "$program" export star.vtkhdf -o star.obj
is "g lines" "$(grep -c '^g ' star.obj)" 7
sed 's/shape: hexagram, size: 40 mm, n: 1/file: star.obj/' star.yaml > again.yaml
expect 0 "$program" check again.yaml; says "groups of faces: hub (6), flap1 (1)"
expect 2 "$program" export star.vtkhdf -o x.csv --per face; says "--per must be group"
expect 2 "$program" export star.vtkhdf -o x.csv --per group --dataset rest; says "exclude each other"
expect 2 "$program" export star.vtkhdf -o x.obj --per group; says "per group is for a CSV"
expect 3 "$program" export strip.vtkhdf -o x.csv --per group; says "nothing is magnetised"
exit $bad
