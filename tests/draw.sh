#!/bin/sh
# Drawings as their users meet them: files, options, pictures of every kind.    tests/draw.sh PROGRAM
. "$(dirname "$0")/expect.sh"

scene=$here/scene_draw.yaml
mkdir out
expect 0 "$program" check "$scene";             says "80 x 50 mm within margins of 5 mm"; says "segments"
expect 0 "$program" run "$scene" -o out/a --set output.gcode=a.gcode --set output.hpgl="$work/b.plt" --set output.every=20
says "pen moves"; says "min to plot"; says "svg: out/a.svg"; says "tone error"
for file in out/a.svg out/a.png out/a.gcode b.plt out/a-000020.svg out/a.vtkhdf; do exists $file; done
for path in spline/nodes spline/strokes spline/pen metrics/tone_rmse metrics/ssim metrics/spacing_cv metrics/crowded metrics/travel final/energy/tone history/energy; do
    expect 0 "$program" info out/a.vtkhdf;      says "slender/$path "
done

# The same drawing again, byte by byte: with other threads, from the result, after an extension of its rounds.
for threads in 5 2 1; do
    expect 0 "$program" run "$scene" --quiet --no-picture -o b --force --threads $threads; same out/a.svg b.svg
done
[ ! -e b.png ] || { echo "--no-picture has made one"; bad=1; }
expect 0 "$program" export out/a.vtkhdf -o c.svg; same out/a.svg c.svg
expect 0 "$program" export out/a.vtkhdf -o c.gcode; same out/a.gcode c.gcode
expect 0 "$program" export out/a.vtkhdf -o c.nc --plotter gcode_servo; grep -q "M3 S30" c.nc || { echo "no servo"; bad=1; }
# In the words of a machine of one's own; a plotter that does not reach so far, and words that stand for nothing, are refused.
sed 's/^origin.*/origin: [0, 0]/' "$here/../scenes/plotters/hp7475a.yaml" > near.yaml
expect 0 "$program" export out/a.vtkhdf -o c.plt --plotter near.yaml; grep -q "^SP1;" c.plt || { echo "no HP 7475A"; bad=1; }
sed 's/276 mm/70 mm/' near.yaml > small.yaml; sed 's/{feed}/{speed}/' "$here/../scenes/plotters/brush.yaml" > wrong.yaml
expect 4 "$program" export out/a.vtkhdf -o d.plt --plotter small.yaml; says "it reaches from (0, 0) to (70, 193) mm"
expect 2 "$program" export out/a.vtkhdf -o d.gcode --plotter wrong.yaml; says 'wrong.yaml:.*"{speed}" stands for nothing'
[ ! -e d.plt ] && [ ! -e d.gcode ] || { echo "a refused plot was written"; bad=1; }
# The scene may name the machine: its file is written by the run, and again from the result alone.
sed "s/^spline:/output: {plotter: m.plt}\nspline:\n  plotter: {profile: near.yaml}/" "$scene" > machine.yaml
cp near.yaml kept.yaml
expect 0 "$program" run machine.yaml --quiet --no-picture -o m; expect 0 "$program" export m.vtkhdf -o c.plt --plotter kept.yaml; same m.plt c.plt
rm near.yaml
expect 0 "$program" export m.vtkhdf -o e.plt --plotter profile; same m.plt e.plt
expect 2 "$program" export out/a.vtkhdf -o e.plt --plotter profile; says "the result has no profile of its own"
expect 2 "$program" export out/a.vtkhdf -o e.plt --plotter foo; says "is no plotter's language"
expect 2 "$program" export out/a.vtkhdf -o e.plt --plotter missing.yaml; says "missing.yaml: cannot be read"
# Nothing is written in a language under the ending of another one.
for wrong in "svg gcode" "svg kept.yaml" "gcode hpgl" "plt gcode_servo" "nc svg"; do
    expect 2 "$program" export out/a.vtkhdf -o "other.${wrong% *}" --plotter "${wrong#* }"; says "is for a file of another ending: "
    [ ! -e "other.${wrong% *}" ] || { echo "${wrong#* } is written as .${wrong% *}"; bad=1; }
done
for words in x.foo x "x.png --animation"; do # shellcheck disable=SC2086
    expect 2 "$program" picture out/a.vtkhdf -o $words; says "are written as"
done
cp small.yaml near.yaml; expect 3 "$program" check machine.yaml; says "near.yaml: the plot has a point where the machine has"
# A file for each pen, or for so much ink: all strokes once, and no file where one of them may not be.
expect 0 "$program" export out/a.vtkhdf -o one.gcode --split pen; says "one_1.gcode: black: "; same out/a.gcode one_1.gcode
[ ! -e one.gcode ] && [ ! -e one_2.gcode ] || { echo "a file too many"; bad=1; }
expect 0 "$program" export out/a.vtkhdf -o ink.svg --split "1 m"; says "ink_2.svg: black: .* m of ink, about"
[ "$(cat ink_*.svg | grep "<path")" = "$(grep "<path" out/a.svg)" ] || { echo "split strokes are not all strokes in their order"; bad=1; }
mkdir no_1.svg; expect 4 "$program" export out/a.vtkhdf -o no.svg --split "1 m"; says "no_1.svg"; [ ! -e no_2.svg ] || { echo "written in part"; bad=1; }
expect 2 "$program" export out/a.vtkhdf -o x.svg --split "1 mT"; says 'split must be pen, or the ink in a file, as "5 m"'
expect 0 "$program" run "$scene" --quiet --no-picture -o fine --set spline.draft=true --set spline.pen=0.3mm
expect 2 "$program" export fine.vtkhdf -o x.svg --split "1 um"; says "files, and 100 are the most"; [ ! -e x_1.svg ] || { echo "too many files"; bad=1; }
expect 2 "$program" export out/a.vtkhdf -o x.csv --dataset metrics/ink --split pen; says "split is for a drawing"
# How the pen is lifted is in the files, in the time, and in what is exported later.
for lift in 0.3 9; do
    expect 0 "$program" run "$scene" --quiet --no-picture -o "lift$lift" --force --set spline.rounds=0 --set output.gcode="lift$lift.gcode" --set output.gcode_servo=s.nc \
        --set "spline.plotter={lift: $lift s, z: {up: 2 mm, down: -1 mm, speed: 1 mm/s}, servo: {up: M3 S90, down: M3 S10}}"
done
grep -q "^G1 Z-1 F60$" lift0.3.gcode || { echo "no z at its speed"; bad=1; }
grep -q "^G1 Z-1 F40$" lift9.gcode || { echo "no z that takes its time"; bad=1; }
[ "$(grep -A1 "^M3 S10$" s.nc | grep -c "^G4 P4.5$")" = "$(grep -c "^M3 S10$" s.nc)" ] || { echo "no pause after lowering"; bad=1; }
expect 0 "$program" export lift9.vtkhdf -o c.gcode; same lift9.gcode c.gcode
expect 0 "$program" export lift9.vtkhdf -o c.gcode --plotter gcode_servo; same s.nc c.gcode
# White paint on black paper: results know both.
expect 0 "$program" run "$scene" --quiet --no-picture -o night --set spline.rounds=0 --set 'spline.paper="#101020"' --set 'spline.pens=[{name: white, opaque: true, width: 0.6 mm}]'
grep -q 'style="background:#101020"' night.svg && ! grep -q multiply night.svg || { echo "no white paint on black paper"; bad=1; }
expect 0 "$program" export night.vtkhdf -o c.svg; same night.svg c.svg
expect 2 "$program" export out/a.vtkhdf -o c.dwg; says "a drawing as .svg"
for ending in glb stl 3mf ply; do expect 3 "$program" export out/a.vtkhdf -o c.$ending; says "a drawing is exported as .svg"; done
expect 0 "$program" export out/a.vtkhdf -o c.npz; exists c.npz
expect 2 "$program" export out/a.vtkhdf -o c.yaml --plotter gcode; says "a drawing as .svg"
expect 0 "$program" picture out/a.vtkhdf -o c.pdf --width 800; exists c.pdf
expect 3 "$program" picture out/a.vtkhdf -o c.png --frame 0; says "the drawing has no frames; .output: {film: N}. keeps those of a run"
expect 3 "$program" picture out/a.vtkhdf -o c.png --stills 3; says "no moments side by side"
expect 0 "$program" run "$scene" --quiet --no-picture -o d --set spline.rounds=0 --set output.film=30
expect 0 "$program" run "$scene" --quiet --no-picture -o d --resume --set output.film=30; same out/a.svg d.svg

# What plotting takes is foretold, and may have an end: the files, added up move by move, keep to it. Runs go on with the
# tones that they began with.
expect 0 "$program" check "$scene";             says "to plot: about .* min, .* m of ink in .* strokes"; says "to compute: about"
foretold=$(sed -n 's/^to plot: about \([0-9.]*\) min.*/\1/p' out.txt)
seconds_of() { # of G-code with a z axis: G0 and G1 with X, Y or Z at F
    awk '/^G[01] / { x2 = x; y2 = y; z2 = z
        for (i = 2; i <= NF; i++) { v = substr($i, 2); if ($i ~ /^X/) x2 = v; if ($i ~ /^Y/) y2 = v; if ($i ~ /^Z/) z2 = v; if ($i ~ /^F/) f = v }
        t += sqrt((x2 - x)^2 + (y2 - y)^2 + (z2 - z)^2)/(f/60); x = x2; y = y2; z = z2 }
        BEGIN { y = 60; z = 5 } END { print t }' "$1"
}
for limit in 1000 60 30; do
    expect 0 "$program" run "$scene" --no-picture -o limit --force --set output.gcode=limit.gcode --set spline.plotter.at_most=${limit}s
    seconds_of limit.gcode | awk -v limit=$limit -v foretold="$foretold" '{ exit !($1 <= limit + 0.5 && (limit == 1000 || $1 > 0.75 * limit)) }' ||
        { echo "no plot of $limit s: $(seconds_of limit.gcode)"; bad=1; }
    [ $limit = 1000 ] || says "to take no more than .* min to plot, the picture is drawn with .* % of its ink"
done
expect 3 "$program" run "$scene" --no-picture -o limit --resume --set output.gcode=limit.gcode --set spline.plotter.at_most=40s; says "spline.plotter.at_most is not the same"
expect 3 "$program" run "$scene" --no-picture -o limit --resume --set output.gcode=limit.gcode --set spline.plotter.at_most=30s --set spline.plotter.down=30mm/s
says "the plotter's speeds may not change"
expect 0 "$program" run "$scene" --quiet --no-picture -o d --resume --set output.film=30 --set spline.plotter.down=30mm/s
expect 3 "$program" check "$scene" --set spline.plotter.at_most=2s; says "less than a tenth of its ink"

# A draft ends well where its iterations do, the same each time.
expect 0 "$program" run "$scene" --quiet --no-picture -o draft --set spline.draft=true --set spline.iterations=12
expect 0 "$program" info draft.vtkhdf;          says "max_iterations"
expect 3 "$program" check "$scene" --set spline.draft=true --set spline.method=gradient; says "spline.draft"

# Its film: the drawing is the same, more rounds go on from what there was; a picture of each frame, and all of them.
expect 0 "$program" run "$scene" --quiet --no-picture -o film --set output.film=30 --set spline.rounds=0
expect 0 "$program" export film.vtkhdf -o film.csv --dataset spline/film/nodes
expect 0 "$program" export d.vtkhdf -o d.csv --dataset spline/film/nodes
lines=$(wc -l < film.csv); head -n "$lines" d.csv | cmp -s - film.csv || { echo "more rounds, another beginning of the film"; bad=1; }
[ "$(wc -l < d.csv)" -gt "$lines" ] || { echo "more rounds, no more of the film"; bad=1; }
expect 0 "$program" picture film.vtkhdf --animation --seconds 0.2 --width 400; exists film.webp
expect 0 "$program" picture film.vtkhdf --frame 1 -o frame.svg; grep -q "<svg" frame.svg || { echo "no frame of a film"; bad=1; }
expect 3 "$program" picture film.vtkhdf --frame 500 -o x.png; says "the drawing's film has [0-9]* frames, from 0"
expect 3 "$program" run "$here/scene_small.yaml" --set output.film=3; says "other jobs have frames, by .every."
expect 3 "$program" run "$scene" --quiet -o d --resume --set spline.pen=1mm; says "spline.pen is not the same"; says "spline.rounds"
expect 0 "$program" run "$scene" --quiet --no-picture -o e --set spline.seed=2; cmp -s out/a.svg e.svg && { echo "another seed, the same drawing"; bad=1; }

# Within an outline: a run that goes on ends with the same bits, and not within another outline.
cat > region.yaml <<'EOF'
slender: 1
job: draw
spline:
  density: "0.2 + 0.3*u"
  page: {size: [60 mm, 40 mm], margin: 2 mm}
  pen: 0.6 mm
  regions: [{svg: moon.svg}]
EOF
echo "<svg xmlns='http://www.w3.org/2000/svg'><circle cx='30' cy='30' r='28'/><circle cx='38' cy='24' r='12'/></svg>" > moon.svg
expect 0 "$program" run region.yaml --quiet --no-picture -o region
expect 0 "$program" run region.yaml --quiet --no-picture -o part --set spline.rounds=0
expect 0 "$program" run region.yaml --quiet --no-picture -o part --resume; same region.svg part.svg
expect 0 "$program" info region.vtkhdf; says "metrics/outside"

# From a result: its strokes as they are, to the last digit of the file; and on from there.
expect 0 "$program" run region.yaml --quiet --no-picture -o whole --set spline.order=as_made
expect 1 "$program" run region.yaml --quiet --no-picture -o again --set "spline.start={file: $work/whole.vtkhdf}" --set spline.order=as_made \
    --set spline.rounds=0 --set spline.iterations=0; same whole.svg again.svg
expect 0 "$program" run region.yaml --quiet --no-picture -o again --force --set "spline.start={file: $work/whole.svg}"
expect 3 "$program" run region.yaml --quiet -o again --force --set "spline.start={file: $work/whole.vtkhdf}" --set spline.cross.from=[0,0.1]; says "crossed sets"

sed 's/28/27/' moon.svg > less.svg; cp less.svg moon.svg
expect 3 "$program" run region.yaml --quiet --no-picture -o part --resume; says "moon.svg"

# Paper and margin; what cannot be written is refused before the work.
expect 0 "$program" run "$scene" --quiet --no-picture -o f --page "a6 landscape" --margin 12mm
grep -q 'width="148mm" height="105mm" viewBox="0 0 148 105"' f.svg || { echo "no A6"; head -3 f.svg; bad=1; }
expect 3 "$program" run "$scene" --quiet -o f --force --page a9; says "no size of paper"
expect 4 "$program" run "$scene" -o g --set output.svg=no/such/g.svg; says "its folder is not there"
[ ! -e g.run ] || { echo "a drawing that cannot be written has begun"; bad=1; }
mkfifo pipe.svg; mkdir folder.svg
expect 4 "$program" run "$scene" -o g --set output.svg=pipe.svg; says "no file, but a device or pipe"
expect 4 "$program" run "$scene" -o g --set output.svg=folder.svg; says "it is a folder"
expect 4 "$program" export out/a.vtkhdf -o pipe.svg; says "no file, but a device or pipe"
[ -p pipe.svg ] || { echo "a pipe was replaced"; bad=1; }
for name in g.run ./g.vtkhdf same.png; do
    expect 4 "$program" run "$scene" -o g --set output.svg=$name --set output.png=same.png; says "would be written twice"
done
[ ! -e g.run ] || { echo "a drawing that would write over itself has begun"; bad=1; }
expect 4 "$program" export out/a.run -o c.svg;  says "a run is exported as .vtkhdf"
expect 0 "$program" info out/a.vtkhdf;          says "out/a.vtkhdf: settled, "
expect 1 "$program" run "$scene" --no-picture -o h --set spline.iterations=3; says "h.svg"
expect 0 "$program" run "$scene" --quiet --no-picture -o i --set spline.order=as_made
for method in newton gradient monte_carlo dynamics; do
    case $method in
        monte_carlo) own="--set spline.monte_carlo.sweeps=5" ;;
        dynamics) own="--set spline.dynamics.steps=10" ;;
        *) own="--set spline.iterations=100000 --set spline.tolerance=0.02" ;;
    esac
    expect 0 "$program" run "$scene" --quiet --no-picture -o m --force --set spline.method=$method --set spline.rounds=0 --set spline.pen=1mm $own
    exists m.svg
done

# Pictures that ask for nothing, or are hardly any; and broken ones.
printf 'P2 1 1 255 40\n' > dot.pgm; printf 'P2 2 2 255 255 255 255 255\n' > white.pgm; printf 'P2 1 1 255 250\n' > light.pgm; printf 'P2 3 1 65535 0 30000 65535\n' > deep.pgm
printf 'P5 100000 100000 255\n' > huge.pgm; printf 'P5 8 8 255\nshort' > cut.pgm; printf '\211PNG\r\n\032\n broken' > broken.png
cat > picture.yaml <<'S'
slender: 1
job: draw
spline: {image: dot.pgm, page: {size: [60 mm, 60 mm], margin: 5 mm}, pen: 1 mm}
S
expect 0 "$program" run picture.yaml -o dot;    says "dot.png"
expect 0 "$program" run picture.yaml -o deep --set spline.image="$work/deep.pgm"
expect 0 "$program" run picture.yaml -o white --set spline.image="$work/white.pgm"; says "0 strokes"
expect 0 "$program" run picture.yaml --no-picture -o light --set spline.image="$work/light.pgm"; says "a finer pen helps"
exists white.svg; exists white.png; grep -q "<path" white.svg && { echo "strokes on white paper"; bad=1; }

# Neither the picture nor the scene is written over: picture.yaml draws picture.png.
awk 'BEGIN { print "P2 64 4 255"; for (i = 0; i < 256; i++) print 4 * (i % 64) }' > picture.png
cp picture.png before.png
expect 4 "$program" run picture.yaml --set spline.image="$work/picture.png" --set output.png=picture.png; says "the scene is made of it"
expect 4 "$program" run picture.yaml --set output.png=picture.gif; says "must be a .png, .svg or .pdf"
expect 0 "$program" run picture.yaml --set spline.image="$work/picture.png"; says "picture: picture-picture.png"
expect 0 "$program" picture picture.vtkhdf; same picture.png before.png; exists picture-picture.png
expect 4 "$program" run picture.yaml --no-picture -o y --set output.gcode=./picture.yaml; says "it is read here"
# Nor by the drawings of iterations.
cp dot.pgm it-000005.svg
expect 4 "$program" run picture.yaml --no-picture -o it --set output.every=1000 --set spline.image="$work/it-000005.svg"; says "by an iteration's drawing"
expect 4 "$program" run picture.yaml --no-picture -o "$work/it" --set output.every=5 --set output.svg=it-000010.svg; says "it-000010.svg' would be written over"
expect 4 "$program" run picture.yaml -o it --set output.every=5 --set output.png=it-000010.svg; says "would be written over"
same it-000005.svg dot.pgm
for other in "output.every=0" "output.svg=it-5.svg" "output.svg=at-000010.svg"; do
    expect 0 "$program" run picture.yaml --quiet --no-picture -o it --force --set output.every=5 --set $other
done
# Without a result they are somebody else's, as other files are; with another one those of the run before go.
for file in at-000010.svg at.gcode; do
    [ $file = at.gcode ] && whose="no 'at.vtkhdf'" || whose="slender has not made it"
    cp dot.pgm $file
    expect 4 "$program" run picture.yaml --quiet --no-picture -o at --set output.every=5 --set output.gcode=at.gcode; says "'$file' is there, and $whose"
    same $file dot.pgm; rm $file
done
expect 0 "$program" run picture.yaml --quiet --no-picture -o at --set output.every=5; exists at-000005.svg
expect 0 "$program" run picture.yaml --quiet --no-picture -o at --set output.every=5
for file in at-000010.svg at.svg; do
    mv $file kept.svg; cp dot.pgm $file
    expect 4 "$program" run picture.yaml --quiet --no-picture -o at --set output.every=5; says "'$file' is there, and slender has not made it"
    same $file dot.pgm; mv kept.svg $file
done
expect 0 "$program" run picture.yaml --quiet --no-picture -o at --force --set output.svg=other.svg
for file in at.svg at-*.svg; do [ ! -e "$file" ] || { echo "$file of another run stays"; bad=1; }; done
expect 2 "$program" run picture.yaml --threads 2x

# Where ink is asked for there are strokes: a narrow strip, no direction anywhere, too few or too long strokes at the start.
grep -q "<path" picture.svg || { echo "a strip without strokes"; bad=1; }
cat > field.yaml <<'S'
slender: 1
job: draw
spline: {density: {formula: 0.2 + 0.2*u}, page: {size: [40 mm, 30 mm], margin: 3 mm}, pen: 0.8 mm}
S
for set in 'direction={formula: ["0", "0"]}' 'direction={formula: ["1e300", "1e300"]}' 'direction={formula: ["1e-300", "0"]}' \
    'direction={image: structure_tensor, detail: 1.0e-300 m}' 'direction={image: structure_tensor, smooth: 1.0e-300 m}' \
    'start={kind: random, ink: 1e-9}' 'start={kind: random, segments: 1000}' 'seed=2147483647'; do
    expect 0 "$program" run field.yaml --quiet --no-picture -o field --force --set "spline.$set"
    grep -q "<path" field.svg || { echo "$set: no strokes"; bad=1; }
done
for name in huge.pgm cut.pgm broken.png; do
    expect 3 "$program" run picture.yaml -o x --set spline.image="$work/$name"; says "$name"
    [ "$(grep -c . err.txt)" -le 3 ] || { echo "$name: more than a sentence"; cat err.txt; bad=1; }
done

# Four inks: a layer and a number for each.
printf 'P3 2 2 255  0 255 255  255 0 255  255 255 0  40 40 40\n' > inks.ppm
expect 0 "$program" run picture.yaml -o inks --set spline.image="$work/inks.ppm" --set spline.separation=cmyk
for layer in 1-cyan 2-magenta 3-yellow 4-black; do grep -q "label=\"$layer\"" inks.svg || { echo "no layer $layer"; bad=1; }; done
printf 'P2 1 1 255 90\n' > grey.pgm # black alone: what a round puts in is black on the way, too
expect 0 "$program" run picture.yaml --quiet --no-picture -o way --set spline.image="$work/grey.pgm" --set spline.separation=cmyk \
    --set output.every=1 --set "spline.start={kind: random, ink: 0.1}"
grep -q 4-black way.svg || { echo "no black"; bad=1; }
grep -l 1-cyan way-*.svg && { echo "strokes of another pen on the way"; bad=1; }
expect 0 "$program" info inks.vtkhdf;           says "metrics/tone_rmse  *real *4"
exit $bad
