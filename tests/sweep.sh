#!/bin/sh
# Sweeps: what their files say and may not say, runs that end in all ways, tables.    tests/sweep.sh PROGRAM
. "$(dirname "$0")/expect_sweep.sh"

# ---- All combinations, the last key fastest; the numbers are those of single runs ----
sweep all 'vary: {shell.thickness: [0.5 mm, 1 mm, 2 mm], shell.gravity: [[0, 0, -9.81], [0, 0, -1]]}
collect: [status, final/energy/bending, probes/tip]
best: {of: final/energy/bending, least: true}'
expect 0 "$program" sweep all.yaml --jobs 2; says "6 done"; says "the best is run 6"
is columns "$(head -1 all.csv)" "run,shell.thickness,shell.gravity.x,shell.gravity.y,shell.gravity.z,status,final/energy/bending,probes/tip.x,probes/tip.y,probes/tip.z,best"
is runs "$(column run all.csv)" "1 2 3 4 5 6"
is thickness "$(column shell.thickness all.csv)" "0.0005 0.0005 0.001 0.001 0.002 0.002"
is gravity "$(column shell.gravity.z all.csv)" "-9.81 -1 -9.81 -1 -9.81 -1"
is status "$(column status all.csv)" "converged converged converged converged converged converged"
is best "$(column best all.csv)" "0 0 0 0 0 1"
same all/best.vtkhdf all/0006.vtkhdf; exists all.h5
for unit in 'm/s^2' J; do tr -c '[:print:]' '\n' < all.h5 | grep -Fqx "$unit" || { echo "all.h5 has no unit $unit"; bad=1; }; done
expect 0 "$program" run strip.yaml --set shell.thickness=2mm --set 'shell.gravity=[0, 0, -9.81]' -o single --no-picture --quiet
numbers() { tr , '\n' | awk '{ printf "%.17g ", $1 }'; }
is tip "$(tail -1 single_probes.csv | cut -d, -f2-4 | numbers)" "$(sed -n 6p all.csv | cut -d, -f8-10 | numbers)"
expect 0 "$program" export single.vtkhdf -o single.csv --dataset final/energy/bending
is energy "$(tail -1 single.csv | numbers)" "$(sed -n 6p all.csv | cut -d, -f7 | numbers)"

# ---- A table made before the first run is the sweep's own ----
sweep early 'vary: {shell.thickness: [1 mm]}
best: {of: final/energy/bending}'
expect 0 "$program" sweep early.yaml --collect; is early "$(column status early.csv)" absent
expect 0 "$program" sweep early.yaml --quiet; is later "$(column status early.csv)" converged
sweep theirs 'vary: {shell.thickness: [1 mm]}'
mkdir theirs; echo raw > theirs/raw.txt; echo a,b > theirs.csv
expect 4 "$program" sweep theirs.yaml; says "'theirs.csv' is there, and no table of this sweep"; is theirs "$(cat theirs.csv)" a,b

# ---- What has too many numbers for columns is in NAME.h5, each run's in its rows ----
sweep wide 'vary: {shell.mesh.cells: [[4, 1], [12, 1]]}
collect: [cases/case1/x, probes/tip]'
expect 0 "$program" sweep wide.yaml; says "cases/case1/x has up to 78 numbers for a run, .* they are in wide.h5 only"
is "narrow" "$(head -1 wide.csv)" "run,shell.mesh.cells[0],shell.mesh.cells[1],status,probes/tip.x,probes/tip.y,probes/tip.z"
! /usr/bin/python3 -c 'import h5py' 2> err.txt || is "wide" "$(/usr/bin/python3 - <<'END'
import h5py, numpy as np
x = h5py.File("wide.h5")["cases/case1/x"]
of = [h5py.File(f"wide/000{k}.vtkhdf")["slender/cases/case1/x"][:] for k in (1, 2)]
print(x.shape, x.attrs["unit"].decode(), (x[0, :10] == of[0]).all(), np.isnan(x[0, 10:]).all(), (x[1] == of[1]).all())
END
)" "(2, 26, 3) m True True True"

# ---- A group is no column: all else is in the table ----
sweep group 'vary: {shell.thickness: [1 mm, 2 mm]}
collect: [final/energy, probes/tip, none/such]'
expect 0 "$program" sweep group.yaml; says "group/0001.vtkhdf: slender/final/energy is no dataset; its cells are empty"
says "none/such is in none of the results"; is "warnings" "$(grep -c '^warning' err.txt)" 2
is "group" "$(column status group.csv); $(column final/energy group.csv); $(column none/such group.csv)" "converged converged;  ;  "
is "beside" "$(column probes/tip.x group.csv | wc -w)" 2; exists group.h5

# ---- Keys that go together, runs from a file, seeds ----
sweep zip 'vary: {zip: true, shell.thickness: [0.5 mm, 1 mm], shell.young: [1 MPa, 2 MPa]}'
expect 0 "$program" sweep zip.yaml --quiet
is zip "$(column shell.thickness zip.csv); $(column shell.young zip.csv)" "0.0005 0.001; 1000000 2000000"
printf '\357\273\277shell.thickness; shell.gravity\n# a remark\n0.5 mm; [0, 0, -1]\n\n"1 mm";"[0, 0, -2]"\n' > runs.csv
sweep file 'vary: {file: runs.csv}'
expect 0 "$program" sweep file.yaml --quiet
is file "$(column shell.gravity.z file.csv)" "-1 -2"
sed 's/equilibrium/design/' strip.yaml > seeded.yaml
printf 'design: {unknowns: {young: {noise: 0.2 MPa}}, objectives: [{height: 1}], iterations: 0}\n' >> seeded.yaml
sweep seeds 'vary: {shell.thickness: [1 mm, 2 mm]}
seeds: 3
best: {of: final/objective, least: true}'
sed -i 's/strip.yaml/seeded.yaml/' seeds.yaml
expect 0 "$program" sweep seeds.yaml --quiet
is seeds "$(column design.seed seeds.csv)" "1 2 3 1 2 3"
is "six starts" "$(column final/objective seeds.csv | tr ' ' '\n' | sort -u | wc -l)" 6

# ---- Values are what they say, in quotes or not; texts are a line for each run ----
expect 0 "$program" mesh strip.yaml -o m.obj; mkdir parts; cp m.obj parts/n.obj
cat > parts/scene.yaml <<'END'
slender: 1
job: equilibrium
shell: {mesh: {file: n.obj}, thickness: 1 mm, young: 1 MPa, poisson: 0.4, density: 1000 kg/m^3}
fix: [{box: [[-1, -1, -1], [1 mm, 1, 1]], clamp: true}]
cases: [{name: up, gravity: [0, 0, 1]}, {name: down, gravity: [0, 0, -1]}]
END
printf 'shell.mesh.file,shell.thickness\n"../m.obj",0.3 mm # thin\nn.obj,300 \302\265m\n' > values.csv
sweep values 'vary: {file: values.csv}
collect: [case_names]'
sed -i 's/strip.yaml/parts\/scene.yaml/' values.yaml
expect 0 "$program" sweep values.yaml -o said --quiet
printf '%s\n' run,shell.mesh.file,shell.thickness,status,case_names '1,../m.obj,0.0003,converged,"up' 'down"' '2,n.obj,0.0003,converged,"up' 'down"' > wanted.csv
same wanted.csv said.csv
for line in 'up\ndown' ../m.obj; do tr -c '[:print:]' '\n' < said.h5 | grep -Fq "$line" || { echo "said.h5 lacks a line"; bad=1; }; done
expect 0 "$program" sweep values.yaml -o said --list; says '^1  shell.mesh.file=../m.obj  shell.thickness=0.3 mm  converged$'

# ---- What has finished is kept; another sweep's results are refused; a run more is one run more ----
touch -d 2001-01-01 zip/000*.vtkhdf
expect 0 "$program" sweep zip.yaml
is kept "$(find zip -name '000*.vtkhdf' ! -newermt 2001-01-02 | wc -l)" 2
sed -i 's/\[1 MPa, 2 MPa\]/[1 MPa, 3 MPa]/' zip.yaml
expect 3 "$program" sweep zip.yaml; says "zip/0002.vtkhdf: it is the result of another scene: shell.young.value is not the same"
expect 0 "$program" sweep zip.yaml --list; says "2  shell.thickness=1 mm  shell.young=3 MPa  changed: zip/0002.vtkhdf: it is the result of another scene: shell.young.value is not the same"
expect 0 "$program" sweep zip.yaml --collect; is changed "$(column status zip.csv)" "converged changed"
expect 0 "$program" sweep zip.yaml --force
is replaced "$(find zip -name '000*.vtkhdf' ! -newermt 2001-01-02)" zip/0001.vtkhdf
sed -i 's/1 mm\]/1 mm, 2 mm]/; s/3 MPa\]/3 MPa, 4 MPa]/' zip.yaml
expect 0 "$program" sweep zip.yaml --index 3; exists zip/0003.vtkhdf
expect 0 "$program" sweep zip.yaml; is more "$(column status zip.csv)" "converged converged converged"

# ---- What is to be longer goes on, to the result of a run in one go; what is to be shorter is refused ----
sweep longer 'vary: {shell.mesh.n: [2], design.iterations: [1, 2]}
collect: [final/objective, history/objective]'
sed -i 's/strip.yaml/scene_small.yaml/' longer.yaml; cp "$here/scene_small.yaml" .
expect 0 "$program" sweep longer.yaml -o whole --quiet
sed -i 's/\[1, 2\]/[1, 1]/' longer.yaml; expect 0 "$program" sweep longer.yaml --quiet
sed -i 's/\[1, 1\]/[1, 2]/' longer.yaml
expect 0 "$program" sweep longer.yaml --list; says "^2 .*shorter"
expect 0 "$program" sweep longer.yaml; says "^run 2 goes on: it was shorter than the scene says now"; same whole.csv longer.csv
sed -i 's/\[1, 2\]/[1, 1]/' longer.yaml
expect 3 "$program" sweep longer.yaml; says "longer/0002.vtkhdf: it is the result of another scene: design.iterations is not the same"

# ---- A result that was deleted is made again, one that is damaged is kept until it is said ----
rm zip/0002.vtkhdf zip/0002.run
expect 0 "$program" sweep zip.yaml; exists zip/0002.vtkhdf
truncate -s 1000 zip/0001.vtkhdf
expect 0 "$program" sweep zip.yaml --list; says "^1  .*damaged: zip/0001.vtkhdf.*: "
expect 3 "$program" sweep zip.yaml; says "zip/0001.vtkhdf .*; with --force it is replaced"
expect 0 "$program" sweep zip.yaml --force; is mended "$(column status zip.csv)" "converged converged converged"

# ---- Runs that fail and do not converge end nothing else ----
sweep bad 'vary: {solver.max_iterations: [1, 50], load_steps: [1, 2]}
best: {of: final/energy/bending}'
mkdir bad; echo junk > bad/0003.run
expect 1 "$program" sweep bad.yaml; says "run 3 has failed with code 4: .*not a journal"
is ends "$(column status bad.csv | sed 's/[a-z_]* [a-z_]* /_ _ /')" "_ _ failed: 4 converged"
is "one solution" "$(column best bad.csv)" "0 0 0 1"; same bad/best.vtkhdf bad/0004.vtkhdf
expect 1 "$program" sweep bad.yaml; says "1 done, 2 did not converge, 1 failed"
expect 0 "$program" sweep bad.yaml --list; says "3  .*failed: 4: .*not a journal"
rm bad/0003.run
expect 1 "$program" sweep bad.yaml --retry; says "2 done, 2 did not converge, 0 failed"

# ---- Where none converges none is the best; of designs that stall one is ----
sed -i 's/\[1, 50\]/[1]/; s/load_steps: \[1, 2\]/load_steps: [1]/' bad.yaml
expect 1 "$program" sweep bad.yaml -o unsolved; says "no result that is a solution has a number at final/energy/bending: none is the best"
is none "$(column best unsolved.csv)" 0; [ ! -e unsolved/best.vtkhdf ] || { echo "none is the best, and is linked"; bad=1; }
cp "$here/scene_small.yaml" .
sweep still 'vary: {shell.mesh.n: [2], design.unknowns.magnetization.noise: [0], "cases[0].flux_density": [[0, 0, 0]], "cases[1].flux_density": [[0, 0, 0]]}
best: {of: final/objective}'
sed -i 's/strip.yaml/scene_small.yaml/' still.yaml
expect 1 "$program" sweep still.yaml --quiet
is still "$(column status still.csv) $(column best still.csv)" "stationary 1"

# ---- What has gone through an obstacle is not the best ----
cat > throw.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: {shape: sheet, size: [10 mm, 10 mm], cells: [10, 10], pattern: alternate}, thickness: 0.2 mm, young: 0.2 MPa, poisson: 0.3}
obstacles: [{sphere: {center: [5.3 mm, 4.8 mm, -2.3 mm], radius: 0.5 mm}}]
time: {step: 1 ms, steps: 1}
END
sweep thrown 'vary: {shell.velocity: [[0, 0, -100], [1, 0, -1], [0, 0, -0.5]]}
best: {of: final/energy/bending}'
sed -i 's/strip.yaml/throw.yaml/' thrown.yaml
expect 1 "$program" sweep thrown.yaml; says "the best is run [23]"
is "thrown" "$(column status thrown.csv)" "pierced converged converged"
is "the most bent" "$(column final/energy/bending thrown.csv | tr ' ' '\n' | sort -g | tail -1)" "$(column final/energy/bending thrown.csv | cut -d' ' -f1)"

# ---- What is refused, each wrong value once, before anything is made ----
refused() { # words, what the file says after its scene
    words=$1; shift; sweep no "$*"
    expect 3 "$program" sweep no.yaml; says "$words"
    [ ! -e no ] || { echo "'$*' has begun"; bad=1; }
}
refused "no.yaml:3:1: the sweep has no key 'colect'; did you mean 'collect'" 'colect: [a]'
refused "no.yaml:3:32: shell.thickness.value must be a number in m, and '1 T' is a flux density" 'vary: {shell.thickness: [1 mm, 1 T], shell.young: [1 MPa, 2 MPa]}'
is "sentences" "$(wc -l < err.txt)" 1
expect 0 "$program" sweep no.yaml --list; says "^3  .*shell.thickness=1 T  shell.young=1 MPa  refused: .*must be a number in m, and '1 T' is a flux density"
refused "no.yaml:3:21: shell has no key 'yong'; did you mean 'young'" 'vary: {shell.yong: [1 MPa]}'
refused "no.yaml:3:21: shell.mesh.file: .*none.obj: cannot be read" 'vary: {shell.mesh: [{file: none.obj}]}'
sweep no 'vary: {shell.mesh.cells: [[4, 1], [1500, 1500], [1, -1]]}' # what does not fit leaves the others to be said
(ulimit -v 500000; exec "$program" sweep no.yaml) > out.txt 2> err.txt; is "large" $? 3
says "no.yaml:3:35: run 2: out of memory"; says "no.yaml:3:49: shell.mesh.cells.1. is -1"
refused "no.yaml:3:63: shell.thickness: it and shell.thickness.value say the same: one of them can be set" 'vary: {shell.thickness.value: [1 mm, 3 mm], shell.thickness: [2 mm]}'
is "sentences" "$(wc -l < err.txt)" 1
refused "no.yaml:3:61: shell.young.value: it and shell.young say the same" 'vary: {zip: true, shell.young: [1 MPa], shell.young.value: [2 MPa]}'
for path in '' / . .. /probes/tip probes/ probes//tip probes/./tip; do
    refused "no.yaml:4:11: collect.0.: '$path' is no path in a result" "vary: {shell.young: [1 MPa]}
collect: [\"$path\"]"
done
for path in run best shell.young; do
    refused "no.yaml:4:19: collect.1.: the table has a column $path of its own" "vary: {shell.young: [1 MPa]}
collect: [status, $path]"
done
refused "no.yaml:4:7: best.of: 'x/' is no path in a result" 'vary: {shell.young: [1 MPa]}
best: x/'
refused "no.yaml:4:18: collect.1.: one of final and final/energy is no dataset" 'vary: {shell.young: [1 MPa]}
collect: [final, final/energy]'
refused "no.yaml:4:23: collect.1.: probes/tip.x is a column of probes/tip already" 'vary: {shell.young: [1 MPa]}
collect: [probes/tip, probes/tip.x]'
refused "no.yaml:4:7: best.of: the status of a run is no number" 'vary: {shell.young: [1 MPa]}
best: status'
refused "nothing is varied" 'collect: [status]'
refused "all keys must have as many values, and shell.young has 2, shell.thickness 1" 'vary: {zip: true, shell.young: [1, 2], shell.thickness: [1]}'
refused "must be a list of entries, not a number" 'vary: {shell.young: 1 MPa}'
refused "give only one of zip, file" 'vary: {zip: true, file: runs.csv}'
refused "the file lists all keys that differ, and 'shell.young' stands beside it" 'vary: {file: runs.csv, shell.young: [1]}'
refused "none.csv: cannot be read" 'vary: {file: none.csv}'
refused "design.seed is varied already" 'vary: {design.seed: [1]}
seeds: 2'
refused "no.yaml:4:8: design.seed: it and design say the same" 'vary: {design: [{seed: 5, unknowns: {young: {noise: 0.2 MPa}}, objectives: [{height: 1}]}]}
seeds: 2'
refused "no.yaml:3:8: seeds: seeds need a design, and .*strip.yaml has none" 'seeds: 2'
printf 'shell.young,shell.thickness\n1 MPa\n' > short.csv
refused "short.csv:2: 1 cells, and the first line names 2 keys" 'vary: {file: short.csv}'
printf 'shell.young\n"1 MPa\n' > quote.csv
refused "quote.csv:2: a quote without an end" 'vary: {file: quote.csv}'
printf 'shell.young,shell.young\n1 MPa,2 MPa\n' > twin.csv
refused "twin.csv:1: the key 'shell.young' is there twice" 'vary: {file: twin.csv}'
printf 'shell.young,shell\n1 MPa,{}\n' > holds.csv
refused "holds.csv:2: shell: it and shell.young say the same" 'vary: {file: holds.csv}'
printf 'shell.young\n1 Mpa\n' > unit.csv
refused "unit.csv:2: shell.young.value must be a number in Pa" 'vary: {file: unit.csv}'
printf 'shell.gravity\n"[0, 0"\n' > open.csv
refused "open.csv:2: shell.gravity: no YAML: did not find expected" 'vary: {file: open.csv}'
printf 'shell[0\n1\n' > key.csv
refused "key.csv:2: shell\[0: the key is malformed" 'vary: {file: key.csv}'
printf 'fix\n[]\n' > free.csv
refused "strip.yaml:1:1: .*nothing holds.*; found in run 1, .*free.csv:2" 'vary: {file: free.csv}'
printf 'shell.young\n1 MPa\n' > no.csv
refused "the sweep's own table will have this name" 'vary: {file: no.csv}'
sweep no 'vary: {shell.young: [1 MPa]}'
expect 4 "$program" sweep no.yaml; says "'no.csv' is there, and no table of this sweep"
sed -i 's/strip.yaml/none.yaml/' no.yaml; expect 3 "$program" sweep no.yaml; says "no.yaml:2:8: scene: .*none.yaml: cannot be read"
echo 'scene: strip.yaml' > no.yaml; expect 3 "$program" sweep no.yaml; says "a sweep must have the key .sweep: 1."
expect 2 "$program" sweep all.yaml --list --collect
expect 2 "$program" sweep all.yaml --retry --force; says "one of them can be given"
for name in . .. ./ out/ ''; do expect 2 "$program" sweep all.yaml -o "$name"; says "the name of a new folder"; done
expect 3 "$program" sweep strip.yaml; says "strip.yaml:1:.*it is a scene, which is one run: slender run strip.yaml"
for verb in run check; do
    expect 3 "$program" $verb all.yaml; says "it is a sweep, .*: slender sweep all.yaml"; is "$verb" "$(wc -l < err.txt)" 1
done
expect 3 "$program" run strip.yaml --set shell.thickness.value=1mm --set shell.thickness=2mm
says "^--set shell.thickness=2mm: it and shell.thickness.value say the same: one of them can be set"
expect 2 "$program" sweep all.yaml --index 7
expect 2 "$program" sweep all.yaml -- --partition=x
expect 1 "$program" sweep bad.yaml --index 1
expect 0 "$program" sweep all.yaml --index 6; says "1 done"
exit $bad
