#!/bin/sh
# Throws a sheet at small things: in the end it lies on them, or the run says (code 1) that it was gone through.
#   tests/pierced.sh PROGRAM [SPEED..]     SPEED: m/s (1 3 10 30 100: a minute)
program=$(realpath "$1")
shift
[ $# -gt 0 ] || set -- 1 3 10 30 100
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2

# a place in it | what it is
things() {
    cat <<'LIST'
5.3 4.8 -2.3 | sphere: {center: [5.3 mm, 4.8 mm, -2.3 mm], radius: 0.5 mm}
5.3 5.0 -2.3 | cylinder: {point: [5.3 mm, 5 mm, -2.3 mm], axis: [0.1, 1, 0], radius: 0.25 mm}
5.3 4.8 -2.4 | box: {center: [5.3 mm, 4.8 mm, -5.3 mm], half: [0.2 mm, 0.2 mm, 3 mm], rounding: 0.1 mm}
LIST
}

scene() { # speed step steps thing
    cat <<SCENE
slender: 1
job: simulate
shell:
  mesh: {shape: sheet, size: [10 mm, 10 mm], cells: [10, 10], pattern: alternate}
  thickness: 0.2 mm
  young: 0.2 MPa
  poisson: 0.3
  density: 1000
  damping: 1.0e-8
  velocity: [0, 0, -$1]
obstacles: [{$4}]
time: {step: $2 s, steps: $3}
SCENE
}

above() { # x y z in mm: how often a ray up from there meets the sheet
    awk -v px="$1" -v py="$2" -v pz="$3" 'BEGIN { px /= 1000; py /= 1000; pz /= 1000 }
        $1 == "v" { n++; x[n] = $2; y[n] = $3; z[n] = $4 }
        $1 == "f" { a = $2 + 0; b = $3 + 0; c = $4 + 0
            d = (x[b] - x[a]) * (y[c] - y[a]) - (y[b] - y[a]) * (x[c] - x[a])
            if (d == 0) next
            u = ((px - x[a]) * (y[c] - y[a]) - (py - y[a]) * (x[c] - x[a])) / d
            v = ((x[b] - x[a]) * (py - y[a]) - (y[b] - y[a]) * (px - x[a])) / d
            if (u >= 0 && v >= 0 && u + v <= 1 && z[a] + u * (z[b] - z[a]) + v * (z[c] - z[a]) > pz) met++ }
        END { print met + 0 }' thrown.obj
}

bad=0
things > things.txt
for speed; do
    for step in 1e-3 1e-4; do
        steps=$(awk -v v="$speed" -v dt="$step" 'BEGIN { n = int(0.006 / (v * dt)); print n < 8 ? 8 : n }')
        while IFS='|' read -r place thing; do
            scene "$speed" "$step" "$steps" "$thing" > thrown.yaml
            "$program" run thrown.yaml --quiet --no-picture --force -o thrown > said.txt 2>&1
            code=$?
            "$program" export thrown.vtkhdf -o thrown.obj > /dev/null
            # shellcheck disable=SC2086
            met=$(above $place)
            echo "${thing%%:*} at $speed m/s, steps of $step s: $met above, code $code"
            [ $code -le 1 ] && [ $((met % 2 == 1 || code == 1)) = 1 ] || { bad=1; cat said.txt; }
        done < things.txt
    done
done
exit $bad
