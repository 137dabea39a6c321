#!/bin/sh
# Kills and interrupts a small job at random moments and resumes it: the end must be that of an undisturbed run, bit by
# bit, seconds aside.
#   tests/campaign.sh PROGRAM [TRIALS] [KIND]      KIND: gauss_newton, mma, lbfgs (quasi-static), simulate, trajectory,
#                                              rod_simulate, rod_design, rod_trajectory, draw, contact, contact_implicit,
#                                              solid, solid_design
program=$1 trials=${2:-20} kind=${3:-gauss_newton}
here=$(cd "$(dirname "$0")" && pwd)
case $kind in
    draw) scene=$here/scene_draw.yaml set=output.film=7 ;;
    rod_design) scene=$here/scene_rod_design.yaml set=design.iterations=60 ;;
    contact) scene=$here/scene_contact.yaml set=output.every=3 ;;
    solid) scene=$here/scene_solid.yaml set=output.every=3 ;;
    solid_design) scene=$here/../scenes/hand_fist.yaml set=design.iterations=4 ;;
    contact_implicit) scene=$here/scene_contact.yaml set=contact.coupling=implicit ;;
    simulate | trajectory | rod_simulate | rod_trajectory) scene=$here/scene_$kind.yaml set=output.every=3 ;;
    *) scene=$here/scene_small.yaml set=design.optimizer=$kind ;;
esac
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
probes='probes={middle: {group: all}, centre: {mass_center: true}}'
[ "$kind" = draw ] && probes=output.every=0
run() { "$program" run "$scene" --set "$set" --set "$probes" --quiet --no-picture -o "$@"; }
start() { exec "$program" run "$scene" --set "$set" --set "$probes" --quiet --no-picture -o "$@"; }
numbers() { # what must be the same; a kind of job has some of them
    for path in design/magnetization design/young design/natural_strain design/flux_density design/gradient/young trajectory/flux_density trajectory/followed trajectory/reference/distance state/x \
        state/v cases/up/x rod/x rod/moment spline/nodes spline/strokes spline/film/nodes spline/film/iteration history/energy frames/x history/contact_force history/friction_work history/self_distance history/water_work history/objective history/newton_iterations history/cg_iterations unknowns; do
        "$program" export "$1" -o out.csv --dataset $path 2>/dev/null && cat out.csv
    done
    [ "$kind" = draw ] || cat "${1%.vtkhdf}_probes.csv"
}
run whole || exit 1
numbers whole.vtkhdf > whole.txt
[ -s whole.txt ] || { echo "nothing to compare"; exit 1; }
start=$(date +%s%N); run again --force || exit 1; took=$(( ($(date +%s%N) - start) / 1000000 ))
bad=0
for trial in $(seq "$trials"); do
    for signal in KILL INT; do
        rm -f part.* part_*
        start part & pid=$!
        pause=$(awk -v seed="$trial$signal" -v ms="$took" 'BEGIN { srand(seed + length(seed) * 7919); print rand() * ms / 1000 }')
        sleep "$pause"
        kill -$signal $pid 2>/dev/null
        wait $pid; code=$?
        if [ $signal = INT ] && [ $code != 0 ] && [ $code != 75 ]; then
            [ -e part.run ] && { echo "Ctrl-C after $pause s: exit code $code"; bad=1; }
        fi
        if [ -s part.run ]; then run part --resume || run part --force; else run part; fi
        numbers part.vtkhdf > part.txt
        cmp -s whole.txt part.txt || { echo "$signal after $pause s: another end"; bad=1; }
    done
done 2>/dev/null
[ $bad = 0 ] && echo "$kind: $trials kills and $trials interruptions of $took ms runs: all ends the same"
exit $bad
