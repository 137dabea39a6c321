#!/bin/sh
# The program over several processes: what it says, its exit codes, and that none of them is left.    tests/mumps.sh PROGRAM
. "$(dirname "$0")/expect.sh"
several() { # how many; others wait without holding processors
    count=$1; shift
    mpirun --allow-run-as-root --oversubscribe --bind-to none --mca mpi_yield_when_idle 1 -n "$count" "$program" "$@"
}
cat > sheet.yaml <<'END'
slender: 1
job: equilibrium
shell: {mesh: {shape: sheet, size: [20 mm, 10 mm], cells: [8, 4]}, thickness: 1 mm, young: 0.1 MPa, poisson: 0.3, density: 1000, gravity: [0, 0, -9.81]}
fix: [{group: root, clamp: true}]
solver: {direct: mumps}
END
once() { [ "$(cat out.txt err.txt | grep -c -- "$1")" = 1 ] || { echo "'$1' is not said once:"; cat out.txt err.txt; bad=1; }; }

expect 0 "$program" version; says "^MUMPS 5"
expect 0 "$program" run sheet.yaml --no-picture; says "factors over 1 process: [0-9]* MB in all"
expect 0 "$program" info sheet.vtkhdf; says "converged"
expect 0 several 2 run sheet.yaml --no-picture -o two; once "factors over 2 processes:"; once "result: two.vtkhdf"
expect 0 several 2 check sheet.yaml; once "vertices, 64 faces"
expect 0 several 2 run sheet.yaml --set solver.direct=cholmod --no-picture -o one; once "of 2 processes one works"; once "result: one.vtkhdf"
expect 4 "$program" run sheet.yaml --no-picture -o one; says "solver.direct is not the same"

# Refusals and failures: one sentence, and the code of slender alone.
expect 3 several 2 run sheet.yaml --set shell.thickness=thin --no-picture -o refused; once "shell.thickness must be"
expect 3 several 2 run missing.yaml; once "missing.yaml: cannot be"
expect 2 several 2 fly; once "there is no verb 'fly'"
expect 4 several 2 run sheet.yaml --no-picture -o no/such/folder; once "no/such/folder"
expect 1 several 2 run sheet.yaml --no-picture -o short --set solver.max_iterations=1 --set load_steps=1; once "short.vtkhdf"

within() { limit=$1; shift; (ulimit -v "$limit"; "$@"); }
expect 5 within 500000 several 2 run sheet.yaml --set "shell.mesh.cells=[364, 180]" --no-picture -o large; once "slender: out of memory"

# A process that is killed takes the others with it; one that is interrupted saves what it has.
cat > moves.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: {shape: sheet, size: [20 mm, 10 mm], cells: [16, 8]}, thickness: 1 mm, young: 0.1 MPa, poisson: 0.3, density: 1000, gravity: [0, 0, -9.81]}
fix: [{group: root, clamp: true}]
time: {step: 1 ms, steps: 100000}
solver: {direct: mumps}
END
processes() { pgrep -f "^$program run moves.yaml -o $1 " | sort -n; }
wait_for() { # so many processes of that run
    for _ in $(seq 300); do [ "$(processes "$1" | wc -l)" = "$2" ] && return; sleep 0.1; done
    echo "$(processes "$1" | wc -l) processes, not $2"; bad=1
}
stepped() { for _ in $(seq 300); do grep -q '"step": [1-9]' "$1.txt" && return; sleep 0.1; done; echo "$1 makes no steps"; bad=1; }
of_rank() { for process in $(processes "$1"); do tr '\0' '\n' < "/proc/$process/environ" | grep -qx "OMPI_COMM_WORLD_RANK=$2" && echo "$process"; done; }
for rank in 0 1; do
    several 2 run moves.yaml -o killed$rank --no-picture --log=json > killed$rank.txt 2>&1 &
    launcher=$!
    stepped killed$rank
    kill -KILL "$(of_rank killed$rank $rank)"
    wait $launcher && { echo "a run whose process $rank was killed ends well"; bad=1; }
    wait_for killed$rank 0
done
steps=$("$program" info killed0.run | sed -n 's/.*, \([0-9]*\) steps*,.*/\1/p')
expect 0 several 2 run moves.yaml -o killed0 --no-picture --resume --set "time.steps=$((steps + 5))"; once "result: killed0.vtkhdf"
several 2 run moves.yaml -o stopped --no-picture --log=json > stopped.txt 2>&1 &
launcher=$!
stepped stopped
kill -INT "$(of_rank stopped 0)"
wait $launcher; code=$?
[ $code = 75 ] && grep -q "interrupted; all is saved" stopped.txt || { echo "an interrupted run ends with $code"; cat stopped.txt; bad=1; }
wait_for stopped 0
exit $bad
