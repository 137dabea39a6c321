#!/bin/sh
# The program as its users meet it: verbs, files, exit codes.    tests/cli.sh PROGRAM
. "$(dirname "$0")/expect.sh"

expect 0 "$program" help;                       says "slender run"
expect 0 "$program" --version;                  says "CHOLMOD"; says "OpenBLAS"; says "NLopt"; says "HDF5"
expect 2 "$program" fly;                        says "no verb 'fly'"
verbs=$("$program" help | sed -n 's/^  slender \([a-z]*\) .*/\1/p')
[ "$(echo "$verbs" | wc -l)" -ge 9 ] || { echo "help lists only" $verbs; bad=1; }
for verb in $verbs; do # --help names every option that there is
    expect 0 "$program" $verb --options; mv out.txt options.txt
    expect 0 "$program" $verb --help; [ ! -s err.txt ] && grep -q "^usage: slender $verb" out.txt || { echo "$verb does not say how it is used"; bad=1; }
    while read -r name letter rest; do
        case $name in
        argument) ;;
        *) grep -q -e "$name" -e "$letter [A-Zk]" out.txt || { echo "$verb --help does not say $name"; bad=1; } ;;
        esac
    done < options.txt
done
expect 0 "$program" picture --options; says "^argument - value RESULT"; says "^--output -o value .png"; says "^--no-arrows - flag$"; says "^--target - value beside over both$"
refuses() { # a sentence, what the program is given ..
    sentence=$1; shift
    expect 2 "$program" "$@"; says "$sentence"; [ "$(cat out.txt err.txt | wc -l)" = 1 ] || { echo "more than a sentence:"; cat out.txt err.txt; bad=1; }
}
refuses "a SCENE must be given" run
refuses "one SCENE can be given, and 2 are, from 'a.yaml'" check a.yaml b.yaml
refuses "'a.yaml': no argument can be given" schema a.yaml
refuses "no option --no-such-option" run --no-such-option x.yaml
refuses "no option -x" run -x x.yaml
refuses "'--quiet=1': this option takes no value" run --quiet=1 x.yaml
for threads in 0 65 2x 1.5 99999999999999999999; do refuses "--threads must be a whole number from 1 to 64, and is '$threads'" run --threads $threads x.yaml; done
refuses "--threads needs a value: a whole number from 1 to 64" run x.yaml --threads
refuses "--log must be json, and is 'xml'" run --log=xml x.yaml
refuses "one of them" run --resume --force x.yaml
refuses "--seconds must be a number from 0.04 to 600, and is 'nan'" picture --seconds nan x.vtkhdf
refuses "--frame must be a whole number from 0, and is '-1'" export --frame -1 x.vtkhdf -o x.obj
refuses "-o FILE must be given" export x.vtkhdf
for verb in run sweep picture report export mesh; do # the second one does not win in silence
    refuses "--output is given twice, the second time as 'b.obj'" $verb x -o a.obj --output b.obj
done
refuses "a RESULT.. must be given" report
refuses "--frames must be a whole number from 1 to 100000, and is '0'" report x.vtkhdf --frames 0
expect 3 "$program" run missing.yaml;           says "missing.yaml: cannot be read"
expect 3 "$program" run "$here/broken/wrong_unit.yaml"; says "must be a number in Pa"
"$program" version | grep -q MUMPS || { expect 3 "$program" run "$here/broken/mumps.yaml"; says "built without it: cmake -DSLENDER_MUMPS=ON"; }
expect 3 "$program" check "$here/../scenes/spline_night.yaml" --set spline.separation.intent=absolute; says "kind is missing: .*; this mapping takes the place of match"

# A million triangles: read, and what they cost foretold, in seconds; a warning of check is one of run, too.
sed 's/mesh: .*/mesh: {shape: sheet, size: [0.2, 0.1], cells: [1024, 512]}/; s/n: 32//' "$here/../scenes/cantilever.yaml" > million.yaml
expect 0 sh -c 'ulimit -t 20; exec "$0" check million.yaml --set shell.bending=hinge --set loads=[]' "$program"
says "1048576 faces"; says "factor.* about [0-9]* million numbers"; says "estimated: .* Newton iterations are assumed"; says "MB of memory"
for verb in check "run --no-picture -o coarse"; do
    # shellcheck disable=SC2086
    expect 0 "$program" $verb "$here/scene_small.yaml" --set shell.thickness=0.2mm --set shell.mesh.n=2 --set design.iterations=0
    says "warning: fewer than 3 cells over the magnetic bending length"
done

# What is doubtful is said by both, before the work: fields that no magnet gives, wherever they are and whenever; targets of
# another size than the body; and nothing of what is not.
cat > doubt.yaml <<'END'
slender: 1
job: design
shell: {mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [4, 2]}, thickness: 1 mm, young: 1 MPa, poisson: 0.3, magnetization: [10 kA/m, 0, 0]}
flux_density: [0, 0, 2 mT]
fix: [{group: root, clamp: true}]
target: ["x", "y", "5*x^2"]
design: {unknowns: {magnetization: {noise: 100}}, objectives: [{target: 1}], iterations: 0}
END
sure() { # settings .. : nothing is doubtful
    "$program" check doubt.yaml "$@" > out.txt 2> err.txt; [ ! -s err.txt ] || { echo "nothing is doubtful, and it says"; cat err.txt; bad=1; }
}
sure
sure --set "design.unknowns={young: {per: body}}"
doubts() { # words, settings ..
    words=$1; shift
    for verb in check "run --no-picture --force -o doubt"; do
        # shellcheck disable=SC2086
        "$program" $verb doubt.yaml "$@" > out.txt 2> err.txt; says "warning: $words"
    done
}
doubts "case1: a flux density of 20 T" --set "flux_density=[0, 0, 20]"
doubts "case1: a flux density of 4 T" --set 'flux_density=["0", "0", "100*x"]'
doubts "case1: the target is 40 m across, and the body 0.0447 m" --set 'target=["1000*x", "y", "0"]'
doubts "the unknown magnetization moves nothing: there is no .flux_density." --set "flux_density=[0, 0, 0]"
doubts "young is 0.001 Pa, and usual is 100 to 1e+13" --set "shell.young=1 mPa"
doubts "young is 10 Pa, and usual is" --set 'shell.young={formula: "x < 0.01 ? 10 : 1e6"}'
doubts "a bound of the unknown young is 0.01 Pa" --set "design.unknowns={young: {bounds: [10 mPa, 2 MPa]}}"
doubts "magnetization is 1e+07 A/m, and usual is 0 to 3e+06" --set "shell.magnetization=[10 MA/m, 0, 0]"
doubts "gravity is -9.81e+03 m/s^2" --set "shell.gravity=[0, 0, -9810]"
doubts "density is 0.001 kg/m^3, and usual is 10 to 30000" --set "shell.density=1 g/m^3"
doubts "density is 1.9 kg/m^3, and usual is 10 to 30000" --set "shell.density=1.9"
doubts "the upper bound of the unknown thickness, 3 m, is more than a fifth" --set "design.unknowns={thickness: {bounds: [0.05, 3]}}"
doubts "the unknown thickness moves nothing: no load, gravity or field acts" --set "flux_density=[0, 0, 0]" --set "design.unknowns={thickness: {bounds: [0.1 mm, 3 mm]}}"
doubts "the thickness, 0.1 m, is more than a fifth of the body's size" --set "shell.thickness=0.1"
sed '/^target/d; /^design/d; s/job: design/job: simulate/' doubt.yaml > still.yaml; mv still.yaml doubt.yaml
doubts "case1: a flux density of 3 T" --set 'flux_density=["0", "0", "3*sin(pi*t)"]' --set "time={step: 0.1, steps: 10}"
doubts "case1: a flux density of 3 T" --set 'flux_density=["0", "0", "3*sin(pi*t)*(1 + 0*x)"]' --set "time={step: 0.1, steps: 10}"
doubts "the flux density moves nothing: nothing is magnetised" --set "shell.magnetization=[0, 0, 0]" --set "time={step: 0.1, steps: 10}"
sed 's/simulate/equilibrium/' doubt.yaml > stages.yaml; mv stages.yaml doubt.yaml
doubts "sequence: a flux density of 2 T" --set "sequence=[{flux_density: [0, 0, 1 mT]}, {flux_density: [0, 2, 0]}, {flux_density: [0, 0, 0]}]"

cat > doubt.yaml <<'END'
slender: 1
job: equilibrium
solid:
  mesh: {shape: box, size: [20 mm, 6 mm, 4 mm], cells: [2, 1, 1]}
  young: 1 MPa
  poisson: 0.3
  skin: {thickness: 1 mm, on: {group: top}, magnetization: {groups: {top: [1 kA/m, 0, 0], left: [1 kA/m, 0, 0]}, other: [0, 0, 0]}}
flux_density: [0, 0, 2 mT]
fix: [{group: left}]
END
doubts "solid.skin.magnetization.groups.left is without effect: .solid.skin.on. leaves it out"
! grep -q "groups.top" err.txt || { echo "what is there is doubted"; bad=1; }
doubts "the skin's thickness, 2 m, is more than a fifth" --set "solid.skin.thickness=2 m"
doubts "the flux density moves nothing: nothing is magnetised" --set "solid.skin.magnetization={groups: {left: [1 kA/m, 0, 0]}, other: [0, 0, 0]}"
doubts "density is 1e+06 kg/m^3" --set "solid.density=1000 g/cm^3"
cat > doubt.yaml <<'END'
slender: 1
job: equilibrium
rod: {length: 100 mm, radius: 1 mm, young: 1 mPa, poisson: 0.5, density: 1100, natural_strain: [0, 0, 0], elements: 10}
END
doubts "young is 0.001 Pa"
doubts "young is 0.001 Pa" --set job=invert --set "rod={curve: {formula: ['u', '0', '-u*u'], range: [0, 0.1]}, radius: 1 mm, young: 1 mPa, poisson: 0.5, density: 1100}"
doubts "density is 0.5 kg/m^3, and" --set "rod.young=1 MPa" --set "rod.density=0.5"

# An equilibrium and everything that can be made of it.
scene=$here/../scenes/cantilever.yaml
expect 0 "$program" check "$scene" --derivatives; says "derivatives of bending"
for motion in simulate rod_simulate; do # in a step of time: what acts only then, and on its start, is not 0
    expect 0 "$program" check "$here/scene_$motion.yaml" --derivatives
    says "derivatives of inertia .* Hessian [1-9].* start of step [1-9]"; says "derivatives of damping .* parameters [1-9]"
done
cat > met.yaml <<'END'
slender: 1
job: simulate
shell:
  mesh: {shape: sheet, size: [40 mm, 20 mm], cells: [12, 6]}
  thickness: 1 mm
  young: 0.2 MPa
  poisson: 0.3
  density: 1000
obstacles: [{name: floor, plane: {point: [0, 0, -1]}}, {name: pin, sphere: {center: [1, 1, 1], radius: 1 mm}}]
contact: {self: true, friction: 0.5}
time: {step: 2 ms, steps: 1}
END
expect 0 "$program" check met.yaml --derivatives # a metre from anything: contact is checked at an obstacle
says "derivatives of contact .* gradient [1-9].* Hessian [1-9].* parameters [1-9]"; says "derivatives of self_contact .*nothing touches there"
says "not in it: further Newton iterations"
expect 0 "$program" run met.yaml --no-picture; says "^2 obstacles: floor (plane, friction 0.5), pin (sphere, friction 0.5)"; says "^contact: "; says "^self contact: "
mkdir out
expect 0 "$program" run "$scene" -o out/beam.vtkhdf; says "result: out/beam.vtkhdf"
expect 0 "$program" run "$scene" --quiet -o beam; [ ! -s out.txt ] || { echo "--quiet is not quiet"; bad=1; }
for file in beam.vtkhdf beam.xdmf beam.png beam.run; do exists $file; done
expect 0 "$program" info beam.vtkhdf;           says "slender/final/lowest_eigenvalue"
expect 0 "$program" info beam.run;              says "finished"
expect 0 "$program" export beam.vtkhdf -o beam.obj; exists beam.obj
expect 0 "$program" export beam.vtkhdf -o x.csv --dataset state/x; exists x.csv
expect 3 "$program" export beam.vtkhdf -o x.csv --dataset state/y; says "no dataset"
expect 3 "$program" export beam.vtkhdf -o x.csv --dataset scene; says "a text, not numbers"
expect 3 "$program" export beam.vtkhdf -o x.obj --frame 7; says "there is no frame 7"
expect 3 "$program" picture beam.vtkhdf -o x.png --frame 7; says "frames, from 0"
expect 2 "$program" export beam.vtkhdf -o x.csv; says "which numbers? --dataset names them"
for ending in png csv.txt vtk; do expect 2 "$program" export beam.vtkhdf -o x.$ending; says "numbers are exported as .csv, with --dataset, a mesh as .obj, a drawing as .svg"; done
expect 2 "$program" export beam.vtkhdf -o x.obj --plotter hpgl; says "plotter is for a drawing"
expect 2 "$program" export beam.vtkhdf -o x.csv --dataset state/x --frame 0; says "frame is for a mesh"
expect 2 "$program" export beam.run -o x.vtkhdf --dataset state/x; says "dataset is not used with a run"
expect 0 "$program" export beam.run -o again.vtkhdf
cmp -s beam.vtkhdf again.vtkhdf || { echo "the journal gives another result"; bad=1; }
for ending in svg pdf png; do expect 0 "$program" picture beam.vtkhdf -o p.$ending --field energy_bending --view 0,-1,0.3; exists p.$ending; done
expect 3 "$program" picture beam.vtkhdf -o p.png --field nothing
cat > rests.yaml <<'END'
slender: 1
job: equilibrium
shell: {mesh: {shape: sheet, size: [10 mm, 10 mm], cells: [4, 4]}, thickness: 1 mm, young: 0.1 MPa, poisson: 0.3, density: 1000, gravity: [0, 0, -9.81]}
obstacles: [{box: {center: [0, 0, -10.5 mm], half: [6 mm, 12 mm, 10 mm]}}]
END
expect 0 "$program" run rests.yaml --no-picture
for field in contact_force none; do expect 0 "$program" picture rests.vtkhdf -o $field.png --field $field; done
! cmp -s contact_force.png none.png || { echo "forces of contact have no colours"; bad=1; }
for view in 0,0,0 nan,0,1 0,-inf,1 1e300,0,0 0,1e-300,0; do expect 2 "$program" picture beam.vtkhdf -o view.png --view=$view; says "not all 0"; done
for plane in x x= w=1 x=nan 1,2,3 0,0,0,0,0,0 0,0,0,1,0,0,5; do expect 2 "$program" picture beam.vtkhdf -o view.png --clip=$plane; says "a normal that is not 0"; done
expect 3 "$program" picture beam.vtkhdf -o view.png --clip x=100; says "the plane does not cut the body, which at rest reaches from"
[ ! -e view.png ] || { echo "a picture from nowhere"; bad=1; }
expect 4 "$program" run "$scene" -o no/such/folder; says "cannot be"
expect 1 "$program" run "$scene" -o short --set solver.max_iterations=2 --set "load_steps=1"; says "short.vtkhdf"
expect 0 "$program" info short.vtkhdf;          says "state/x"
expect 0 "$program" run "$scene" -o json --log=json; says '"step": 1, "of": 1, "seconds": [0-9.]*, "left": 0,'
expect 0 "$program" schema;                     says "json-schema.org"
expect 0 "$program" schema --keys;              says "^shell.thickness=$"; says "^job=design$"; says "^fix\[0\].ball.radius=$"
expect 2 "$program" schema --keys --manual;     says "exclude each other"
expect 0 "$program" schema --manual;            says "| .thickness. |"
"$program" schema --manual | cmp -s - "$here/../docs/scene.md" || { echo "docs/scene.md is not what slender schema --manual says"; bad=1; }

"$program" schema | cmp -s - "$here/../docs/scene.schema.json" || { echo "docs/scene.schema.json is not what slender schema says"; bad=1; }

# Nothing that a verb reads, and no journal, is lost by what it writes, under whatever name.
cp "$scene" own.yaml; cp "$scene" own.xdmf; ln -s beam.vtkhdf beam.csv; ln beam.vtkhdf hard.csv; ln -s beam.run beam.png2.png
cp beam.vtkhdf keep.vtkhdf; cp beam.run keep.run
for output in ./beam.vtkhdf beam.csv hard.csv "$PWD/beam.vtkhdf" out/../beam.vtkhdf; do
    expect 4 "$program" export beam.vtkhdf -o "$output" --dataset state/x; says "but it is read here"
    expect 4 "$program" export beam.vtkhdf -o "$output"; says "but it is read here"
done
for output in beam.run ./beam.run beam.run-wal beam.run-shm beam.run-lock beam.png2.png; do
    expect 4 "$program" export beam.vtkhdf -o $output --dataset state/x; says "a run's journal"
    expect 4 "$program" mesh own.yaml -o $output; says "a run's journal"
done
expect 4 "$program" picture beam.vtkhdf -o beam.png2.png; says "a run's journal"
for output in beam.run-wal again.vtkhdf own.yaml a.pdf .html; do
    expect 2 "$program" report beam.vtkhdf -o $output; says "must end in .html or .htm"
done
cp beam.vtkhdf beam.html
expect 4 "$program" report again.vtkhdf beam.html -o ./beam.html; says "but it is read here"; same beam.html beam.vtkhdf; rm beam.html
expect 4 "$program" export beam.run -o again.vtkhdf.run; says "exported as .vtkhdf"
expect 4 "$program" mesh own.yaml -o ./own.yaml; says "but it is read here"
expect 4 "$program" run own.xdmf --quiet --no-picture; says "but it is read here"
same own.yaml "$scene"; same own.xdmf "$scene"; same beam.vtkhdf keep.vtkhdf; same beam.run keep.run
"$program" mesh own.yaml -o star.obj; cp star.obj keep.obj
sed "s/{shape: strip.*}/star.obj/; s/{group: root, clamp: true}/{box: [[-1, -1, -1], [1e-9, 1, 1]], clamp: true}/" own.yaml > star.yaml
expect 4 "$program" mesh star.yaml; says "the scene is made of it"
expect 0 "$program" run star.yaml --quiet --no-picture
expect 4 "$program" export star.vtkhdf -o star.obj; says "the scene is made of it"
expect 4 "$program" export star.vtkhdf -o ./star.obj --dataset state/x; says "the scene is made of it"
mkdir aside; (cd aside; expect 4 "$program" export ../star.vtkhdf -o ../star.obj; says "the scene is made of it"; exit $bad) || bad=1
expect 2 "$program" export star.vtkhdf -o star.yaml --dataset state/x; says "numbers are exported as .csv"
expect 2 "$program" export star.vtkhdf -o star.yaml; says "a mesh as .obj"
grep -q "star.obj" star.yaml || { echo "the scene is written over"; bad=1; }
ln -s star.obj star.svg; ln -s star.obj star.html
expect 4 "$program" report beam.vtkhdf star.vtkhdf -o star.html; says "the scene is made of it"
expect 4 "$program" picture star.vtkhdf -o star.svg; says "the scene is made of it"
mkfifo pipe.vtkhdf; cp beam.run beam-run.vtkhdf
for verb in "picture -o p.png" "report -o p.html" info "export -o o.obj"; do # what is no result is named, and what to do
    expect 3 "$program" ${verb} "$here/scene_small.yaml"; says "scene_small.yaml is no result of slender, but a scene: slender run"
    expect 3 "$program" ${verb} beam-run.vtkhdf; says "beam-run.vtkhdf is no result of slender, but a run's journal: slender export"
    expect 3 timeout 5 "$program" ${verb} pipe.vtkhdf; says "it is no file, but a device or pipe"
done
echo junk > junk.vtkhdf; echo junk > junk.run
for input in missing.vtkhdf junk.vtkhdf; do # what cannot be read is refused by every verb alike
    expect 3 "$program" info $input; expect 3 "$program" picture $input -o p.png; expect 3 "$program" export $input -o o.obj
    expect 3 "$program" report beam.vtkhdf $input -o p.html; says "$input"; [ ! -e p.html ] || { echo "a report of what cannot be read"; bad=1; }
done
expect 0 "$program" report beam.vtkhdf again.vtkhdf --frames 2; exists beam.html
for input in missing.run junk.run; do expect 3 "$program" info $input; expect 3 "$program" export $input -o o.vtkhdf; done
same star.obj keep.obj

# What cannot be printed is said, and is no success.
for words in schema help version "info beam.vtkhdf" "info beam.run" "check $scene" "run $scene --no-picture -o full --log=json"; do
    # shellcheck disable=SC2086
    "$program" $words > /dev/full 2> err.txt; code=$?
    [ $code = 4 ] && grep -q "what it prints cannot be written" err.txt || { echo "$words to a full disk ends with $code"; bad=1; }
    # shellcheck disable=SC2086
    "$program" $words --force >&- 2> err.txt; code=$?
    [ $code = 4 ] || [ $code = 2 ] || { echo "$words to a closed stream ends with $code"; bad=1; }
done
"$program" run "$scene" --quiet --no-picture -o closed >&- 2>&-; code=$?
[ $code = 0 ] || { echo "a quiet run without streams ends with $code"; bad=1; }
expect 0 "$program" info closed.vtkhdf

# A reader that has enough, as `head` has, ends nothing and is no fault.
rm -f unread.*
for words in "run $scene --no-picture -o unread --log=json" "info beam.vtkhdf" schema; do
    # shellcheck disable=SC2086
    { sleep 0.2; "$program" $words 2> err.txt; echo $? > code.txt; } | true
    [ "$(cat code.txt)" = 0 ] && [ ! -s err.txt ] || { echo "$words, which nobody reads, ends with $(cat code.txt)"; cat err.txt; bad=1; }
done
same unread.vtkhdf beam.vtkhdf

# A picture that cannot be drawn is said by a quiet run, too: files may have 300 blocks, and it alone has more.
(ulimit -f 300; "$program" run "$here/scene_small.yaml" --set shell.mesh.n=2 --set design.iterations=0 --quiet -o undrawn) > out.txt 2> err.txt; code=$?
[ $code = 4 ] || { echo "a quiet run without its picture ends with $code"; bad=1; }
says "no picture: undrawn.png: cannot be written: File too large"
[ "$(echo undrawn.*)" = "undrawn.run undrawn.run-lock undrawn.vtkhdf undrawn.xdmf" ] || { echo "left: $(echo undrawn.*)"; bad=1; }

# A limit of file sizes is what a full disk is, wherever it strikes: at the journal's beginning, within it, at what is
# written of a result; the run then goes on to the same end.
within() { blocks=$1; shift; (ulimit -f "$blocks"; "$@"); }
for blocks in 16 60 300; do
    expect 4 within $blocks "$program" run "$scene" --quiet --no-picture -o large; says "slender: large.*: cannot be written: .*\(files may have at most [0-9]* bytes\|File too large\)"
    "$program" run "$scene" --quiet --no-picture -o large --resume 2> err.txt || expect 0 "$program" run "$scene" --quiet --no-picture -o large
    same large.vtkhdf beam.vtkhdf; rm large.*
done
expect 4 within 16 "$program" run "$scene" --quiet -o stump; expect 3 "$program" info stump.run; says "stump.run is incomplete"
expect 4 "$program" run "$scene" --quiet -o stump --resume; says "ended before anything was saved"
expect 4 within 16 "$program" export beam.vtkhdf -o large.csv --dataset VTKHDF/Points; says "large.csv: cannot be written: File too large"
expect 4 within 16 "$program" export beam.vtkhdf -o large.obj; says "large.obj: cannot be written: File too large"
within 16 "$program" schema > large.json 2> err.txt; code=$?
[ $code = 4 ] || { echo "a schema beyond the limit of file sizes ends with $code"; bad=1; }
says "what it prints cannot be written"

# The mesh as a file, the pose evaluated: the energies are those of the equilibrium.
expect 0 "$program" mesh "$scene" -o rest.obj;  exists rest.obj
sed "s/^job: .*/job: evaluate/; s/{shape: strip.*}/rest.obj/; s/^  thickness/  pose: beam.obj\n  thickness/; s/{group: root, clamp: true}/{box: [[-1, -1, -1], [1e-9, 1, 1]], clamp: true}/" "$scene" > evaluate.yaml
expect 0 "$program" run evaluate.yaml;          says "an equilibrium, stable"
"$program" info evaluate.vtkhdf | grep -q 'cases/case1/status *text *converged' || { echo "an equilibrium is not called one"; bad=1; }
expect 0 "$program" run evaluate.yaml -o leaning --set 'shell.gravity=[0,0,-5]'; says "but no equilibrium: forces of up to"
"$program" info leaning.vtkhdf | grep -q 'cases/case1/status *text *evaluated' || { echo "a pose out of balance is called an equilibrium"; bad=1; }
for term in membrane bending gravity load; do
    "$program" info beam.vtkhdf | awk "/final.energy.$term/ {print \$3}" > a.txt
    "$program" info evaluate.vtkhdf | awk "/final.energy.$term/ {print \$3}" > b.txt
    awk -v a="$(cat a.txt)" -v b="$(cat b.txt)" 'BEGIN { exit !(a != "" && (a - b)^2 <= 1e-12 * a * a) }' || { echo "energy of $term: $(cat a.txt b.txt)"; bad=1; }
done

# What is not magnetised is not coloured; an arrow shows where gravity points, not how strong it is.
"$program" picture beam.vtkhdf -o coloured.png; "$program" picture beam.vtkhdf -o plain.png --field none; same coloured.png plain.png
for gravity in 0,0,-5 0,0,-1 5,0,0; do
    mkdir "towards $gravity"
    expect 0 "$program" run evaluate.yaml --quiet -o "towards $gravity/pose" --set "shell.gravity=[$gravity]"
done
same "towards 0,0,-5/pose.png" "towards 0,0,-1/pose.png"
cmp -s "towards 0,0,-5/pose.png" "towards 5,0,0/pose.png" && { echo "no picture shows gravity"; bad=1; }

# A run that lives keeps others away; one that was stopped is not overwritten, and goes on with --resume.
long="$here/scene_small.yaml --set design.iterations=100000 --set design.tolerance=0 --set design.optimizer=mma"
# shellcheck disable=SC2086
"$program" run $long --quiet --no-picture -o live & pid=$!
until "$program" info live.run 2> err.txt | grep -q objective; do sleep 0.1; kill -0 $pid || break; done
expect 4 "$program" run "$here/scene_small.yaml" --quiet -o live --force; says "another run is writing"
kill -INT $pid; wait $pid; code=$?
[ $code = 75 ] || { echo "Ctrl-C ends with $code"; bad=1; }
expect 0 "$program" info live.vtkhdf;           says "state/x"
expect 4 "$program" run "$here/scene_small.yaml" --quiet -o live; says "unfinished run"
# shellcheck disable=SC2086
expect 3 "$program" run $long --quiet -o live --resume --set shell.young=2e5; says "shell.young"
# shellcheck disable=SC2086
expect 0 "$program" run $long --quiet --no-picture -o live --resume --set design.iterations=1
for folder in out out/; do
    expect 4 "$program" run "$scene" -o $folder; says "is a folder"
done
expect 4 "$program" run "$scene" -o no/such --no-picture; says "cannot be written: its folder is not there"
mkdir folder.run
expect 4 "$program" run "$scene" -o folder;     says "the journal 'folder.run' is a folder"
rmdir folder.run
mkdir folder.vtkhdf
expect 4 "$program" run "$scene" -o folder;     says "'folder.vtkhdf' is a folder"
[ ! -e folder.run ] || { echo "a run that cannot be written has begun"; bad=1; }
expect 3 "$program" run out;                    says "Is a directory"

# The time of a motion may stay where its scene is put to rest.
expect 0 "$program" check "$here/../scenes/strip_vibration.yaml" --set job=equilibrium --set output.every=0

# A simulation that is killed or extended ends as one that is not.
vibration="$here/../scenes/strip_vibration.yaml --set shell.mesh.n=12 --set output.every=7 --quiet --no-picture"
# shellcheck disable=SC2086
{
    expect 0 "$program" run $vibration --set time.steps=200 -o straight
    expect 0 "$program" run $vibration --set time.steps=30 -o halves
    expect 0 "$program" run $vibration --set time.steps=200 -o halves --resume
    "$program" run $vibration --set time.steps=200 -o killed & pid=$!
    until [ "$("$program" info killed.run 2> err.txt | sed -n 's/.* \([0-9]*\) frames.*/\1/p')" -gt 2 ] 2> err.txt; do sleep 0.02; kill -0 $pid 2> err.txt || break; done
    kill -9 $pid 2> err.txt; wait $pid 2> err.txt
    expect 0 "$program" run $vibration --set time.steps=200 -o killed --resume
}
for name in halves killed; do
    for path in state/x state/v VTKHDF/Points history/newton_iterations; do
        "$program" export straight.vtkhdf -o a.csv --dataset $path; "$program" export $name.vtkhdf -o b.csv --dataset $path
        cmp -s a.csv b.csv || { echo "$name: $path is another than without the break"; bad=1; }
    done
done

expect 4 "$program" export straight.run -o again.vtkhdf;      says "its frames are in its result"
expect 0 "$program" picture halves.vtkhdf --animation --seconds 0.4 --width 400
[ "$(head -c 12 halves.webp | tail -c 4)" = WEBP ] && grep -q ANMF halves.webp || { echo "halves.webp is no animation"; bad=1; }
expect 0 "$program" picture halves.vtkhdf --stills 3 -o stills.svg; [ -s stills.svg ] || { echo "no stills"; bad=1; }
expect 2 "$program" picture halves.vtkhdf --stills 3 --animation
expect 2 "$program" picture halves.vtkhdf --stills none

# A rod that rests elsewhere than on its curve: in which equilibrium, and with how much less energy.
expect 0 "$program" run "$here/../scenes/rod_ellipse.yaml" --no-picture -o ellipse; says "in another equilibrium, with up to 0.000976 J less energy"
expect 0 "$program" export ellipse.vtkhdf -o a.csv --dataset metrics/energy_above

# A design whose start has no equilibrium: said, and no word of pictures.
expect 1 "$program" run "$here/scene_small.yaml" -o unsolved --set solver.max_iterations=1; says "no solution was found for the start"
"$program" info unsolved.vtkhdf | head -1 | grep -q unsolved || { echo "an unsolved design has another status"; bad=1; }

# A finished design goes on when it is given more iterations.
expect 0 "$program" run "$here/scene_small.yaml" --quiet --no-picture -o more --set design.iterations=4
expect 0 "$program" run "$here/scene_small.yaml" --quiet --no-picture -o more --resume --set design.iterations=8
expect 0 "$program" run "$here/scene_small.yaml" --quiet --no-picture -o once --set design.iterations=8
"$program" export more.vtkhdf -o a.csv --dataset design/magnetization; "$program" export once.vtkhdf -o b.csv --dataset design/magnetization
cmp -s a.csv b.csv || { echo "an extended design ends elsewhere"; bad=1; }
expect 0 "$program" run "$here/scene_small.yaml" --quiet --no-picture -o more --resume --set design.iterations=8
"$program" info more.vtkhdf | head -1 | sed 's/more//' > a.txt; "$program" info once.vtkhdf | head -1 | sed 's/once//' > b.txt
cmp -s a.txt b.txt || { echo "an extended design has other frames"; cat a.txt b.txt; bad=1; }
# An obstacle a hundred million times larger than the body: its faces' corners are beyond all integers.
cat > huge.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: {shape: sheet, size: [0.02, 0.02], cells: [2, 2]}, thickness: 1 mm, young: 1 MPa, poisson: 0.4}
obstacles: [{sphere: {center: [0.01, 0.01, -1.0e6], radius: 1.0e6}}]
time: {step: 1 ms, steps: 1}
END
expect 0 timeout -k 1 60 "$program" run huge.yaml -o huge --quiet; exists huge.png
exit $bad
