#!/bin/sh
# Lets the i-th write, sync, truncation or rename of a small job fail, for every i (or every STEP-th) until a run
# passes untouched. Each time: the run ends with a sentence and exit code 4, or is done; the old result is there or the
# new one, whole; what the journal has acknowledged is there, and a resumed run comes to the same end.
#   tests/faults.sh PROGRAM SHIM [STEP] [KIND]      KIND: design, simulate, draw
program=$1 shim=$2 step=${3:-1} kind=${4:-design}
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
case $kind in
    design) scene="$here/scene_small.yaml --set shell.mesh.n=2 --set design.iterations=3 --set design.optimizer=mma"
        dataset=design/magnetization unit=objective ;;
    simulate) scene="$here/scene_simulate.yaml --set shell.mesh.n=4 --set time.steps=9" dataset=frames/x unit="Newton iterations" ;;
    draw) scene="$here/scene_draw.yaml --set spline.pen=1mm --set spline.rounds=1 --set output.hpgl=part.plt" dataset=spline/nodes unit=energy ;;
esac
scene="$scene --no-picture"
numbers() { "$program" export "$1" -o out.csv --dataset $dataset && cat out.csv; }
# shellcheck disable=SC2086
"$program" run $scene -o whole --quiet || exit 1
numbers whole.vtkhdf > whole.txt
struck=0 bad=0 i=1
fail() { echo "fault $i ($stays): $1"; cat said.txt; bad=1; }
for stays in "" 1; do
    i=1
    while :; do
        rm -f part.* fault.log
        cp whole.vtkhdf part.vtkhdf
        # shellcheck disable=SC2086
        FAULT_AT=$i FAULT_STAYS=$stays FAULT_LOG=fault.log LD_PRELOAD=$shim "$program" run $scene --log=json -o part 2> said.txt > steps.txt
        code=$?
        acknowledged=$(sed -n 's/^{"step": \([0-9]*\),.*/\1/p' steps.txt | tail -1)
        [ -e fault.log ] || break
        struck=$((struck + 1))
        [ $code = 0 ] || [ $code = 4 ] || fail "exit code $code"
        [ $code = 0 ] || grep -q '^slender: ' said.txt || fail "no sentence"
        "$program" info part.vtkhdf > /dev/null 2> said.txt || fail "the result is damaged"
        if [ "${acknowledged:-0}" -gt 0 ]; then
            "$program" info part.run > info.txt 2> said.txt || fail "the journal is damaged"
            [ "$(grep -c "$unit" info.txt)" -ge "$acknowledged" ] || fail "an acknowledged unit is lost"
        fi
        # shellcheck disable=SC2086
        { "$program" run $scene --quiet -o part --resume || "$program" run $scene --quiet -o part; } 2> said.txt ||
            fail "cannot go on"
        numbers part.vtkhdf > part.txt
        cmp -s whole.txt part.txt || fail "another end"
        [ "$kind" != draw ] || cmp -s whole.svg part.svg || fail "another drawing"
        i=$((i + step))
    done
    [ -n "$stays" ] || [ $code = 0 ] || fail "a run without a fault ends with $code"
done
[ $bad = 0 ] && echo "$kind: $struck faults: each said, nothing lost"
exit $bad
