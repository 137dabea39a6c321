# What tests of sweeps share, as expect.sh: a scene of a strip, sweeps of it, columns of tables.
# shellcheck shell=sh
. "$(dirname "$0")/expect.sh"
is() { [ "$2" = "$3" ] || { echo "$1: '$2', not '$3'"; bad=1; }; }
column() { # of a table without quotes: its name, the file
    awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) k = i; if (!k) print "no column " name }
                          NR > 1 && k { printf "%s%s", (NR > 2 ? " " : ""), $k } END { print "" }' "$2"
}
sweep() { name=$1; shift; printf 'sweep: 1\nscene: strip.yaml\n%s\n' "$*" > "$name.yaml"; }
cat > strip.yaml <<'END'
slender: 1
job: equilibrium
shell: {mesh: {shape: sheet, size: [20 mm, 5 mm], cells: [4, 1]}, thickness: 1 mm, young: 1 MPa, poisson: 0.4, density: 1000 kg/m^3, gravity: [0, 0, -9.81]}
fix: [{group: root, clamp: true}]
probes: {tip: {group: tip}}
END
