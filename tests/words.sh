#!/bin/sh
# Words of users' files and names of files, where they are printed and written.    tests/words.sh PROGRAM
. "$(dirname "$0")/expect.sh"
esc=$(printf '\033') bell=$(printf '\007')
clean() { # nothing that a terminal would obey
    ! LC_ALL=C grep -q "[$esc$bell]" out.txt err.txt || { echo "a control character reaches the terminal:"; cat -v out.txt err.txt; bad=1; }
}
json() { # one object per line
    ! grep -v '^{".*"}$' out.txt || { echo "no JSON line"; bad=1; }
    ! /usr/bin/python3 -c 'import json' 2> /dev/null || /usr/bin/python3 -c 'import json, sys
for line in sys.stdin: json.loads(line)' < out.txt || { echo "a line is no JSON"; bad=1; }
}
cat > scene.yaml << 'END'
slender: 1
job: equilibrium
shell:
  mesh: {shape: sheet, size: [40 mm, 5 mm], cells: [4, 2]}
  thickness: 0.5 mm
  young: 0.1 MPa
  poisson: 0.5
  magnetization: [0, 0, 1e4]
fix:
  - {group: root, clamp: true}
cases:
  - {name: 'a"b\c', flux_density: [1 mT, 0, 0]}
  - {name: "Zähne & <Zangen>", flux_density: [2 mT, 0, 0]}
END

expect 0 "$program" run scene.yaml -o a --log=json; clean; json
expect 0 "$program" picture a.vtkhdf -o a.svg
expect 3 "$program" run scene.yaml --log=json --set "cases[0].name=\"x\\e]0;t\\a\""; clean; json; says '"error": '; says "control characters"
expect 3 "$program" run scene.yaml --log=json --set "job=\"e\\e[2Jq\""; clean; json; says 'x1b\[2Jq'
expect 4 "$program" run scene.yaml --log=json -o "no/such\"$esc/x"; clean; json
expect 3 "$program" run "$esc[2J.yaml"; clean
expect 2 "$program" "$esc[2J"; clean
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\ng a\033[2Jb\nf 1 2 9\n' > m.obj
expect 3 "$program" check scene.yaml --set shell.mesh=m.obj; clean
printf '1, \033[2J\n' > young.csv
expect 3 "$program" check scene.yaml --set shell.young.file=young.csv; clean

# Any name of a result: a sidecar that XML can be, or none and a warning; a picture in any case.
for name in plain "with space" "R&D" "a<b>'" "12:30:05" "a|b" " blank " "$(printf 'bell\007')" "$(printf 'byte\377')"; do
    rm -f ./*.xdmf
    expect 0 "$program" run scene.yaml -o "$name" --quiet; clean
    exists "$name.vtkhdf"; exists "$name.png"
    case $name in
    plain | with* | R* | "a<b"*) exists "$name.xdmf"; ! grep -q xdmf err.txt || { echo "'$name' is warned of"; bad=1; } ;;
    *) [ ! -e "$name.xdmf" ] || { echo "'$name' has a sidecar that nobody can read"; bad=1; }; says "warning: .*no .xdmf" ;;
    esac
    [ ! -e "$name.xdmf" ] || ! grep -q '[^#]&[^#]\|[<>]b' "$name.xdmf" || { echo "'$name' is not escaped"; bad=1; }
    expect 0 "$program" info "$name.vtkhdf"; clean
done
exit $bad
