#!/bin/sh
# Sweeps whose runs are under way: interrupted, killed, elsewhere, on a cluster.    tests/sweep_stops.sh PROGRAM
. "$(dirname "$0")/expect_sweep.sh"

# ---- Interrupted and killed runs go on to the numbers of those that were not ----
cat > motion.yaml <<'END'
slender: 1
job: simulate
shell: {mesh: {shape: sheet, size: [20 mm, 5 mm], cells: [4, 1]}, thickness: 1 mm, young: 1 MPa, poisson: 0.4, density: 1000 kg/m^3, gravity: [0, 0, -9.81]}
fix: [{group: root, clamp: true}]
time: {step: 1 ms, steps: 2000}
output: {every: 100}
END
try_hold() { # a sweep's name, options: run 1 is under way in $pid, and its own process, $child, stands still
    rm -rf "$1" "$1.csv" "$1.h5"
    "$program" sweep "$1.yaml" --jobs 1 --quiet $2 & pid=$!
    until "$program" info "$1/0001.run" > out.txt 2>&1; do kill -0 $pid 2> err.txt || break; done
    child=$(pgrep -P $pid) && kill -STOP "$child" && "$program" sweep "$1.yaml" --list | grep -q '^1 .*running'
}
hold() { # again where it had ended before
    until try_hold "$@"; do
        kill -CONT "$child" 2> err.txt
        wait $pid || { echo "$1 cannot be held"; exit 1; }
    done
}
for name in whole parts left; do
    sweep $name 'vary: {shell.young: [1 MPa, 2 MPa]}
collect: [final/energy/bending, final/energy/membrane]'
    sed -i 's/strip.yaml/motion.yaml/' $name.yaml
done
"$program" sweep whole.yaml --quiet
hold parts
expect 76 "$program" sweep parts.yaml --index 1; says "under way elsewhere"
expect 0 "$program" sweep parts.yaml --list; says "1  .*running"
kill -INT $pid; kill -CONT "$child"; wait $pid; is "Ctrl-C" $? 75
is interrupted "$(column status parts.csv)" "interrupted absent"
expect 0 "$program" sweep parts.yaml --jobs 2 --quiet
same whole.csv parts.csv
trap '' HUP # what stands still when its parent dies is sent one, and goes on
try_left() {
    hold left
    kill -9 $pid; wait $pid 2> err.txt
    kill -STOP "$child" && "$program" sweep left.yaml --list | grep -q '^1 .*running'
}
until try_left; do kill -9 "$child" 2> err.txt; done
expect 76 "$program" sweep left.yaml --index 1 # the run that the sweep has left behind
kill -9 "$child"; while kill -0 "$child" 2> err.txt; do sleep 0.02; done
expect 0 "$program" sweep left.yaml --jobs 2 --quiet
same whole.csv left.csv

# ---- A scene that is edited meanwhile: no run of another one is begun; put back, it goes on ----
hold parts
echo '# a remark' >> motion.yaml # is no other scene
kill -CONT "$child"; wait $pid; is "remark" $? 0; same whole.csv parts.csv
cp motion.yaml before.yaml
hold parts 2> edited.txt
sed -i 's/poisson: 0.4/poisson: 0.3/' motion.yaml
kill -CONT "$child"; wait $pid; is "edited" $? 75
grep -q "motion.yaml has changed since the sweep began: no further run is begun" edited.txt || { echo "nothing says why it ends"; bad=1; }
is "edited" "$(column status parts.csv)" "changed absent"
expect 3 "$program" sweep parts.yaml; says "parts/0001.vtkhdf: it is the result of another scene: shell.poisson is not the same"
cp before.yaml motion.yaml
expect 0 "$program" sweep parts.yaml; same whole.csv parts.csv

# ---- What another process was at, and has done by the end, is done ----
sweep both 'vary: {time.steps: [1999, 2000]}'
sed -i 's/strip.yaml/motion.yaml/' both.yaml
try_both() { # run 1 is held, and the sweep $main, which set it aside and is at run 2, stands still
    hold both "--index 1"
    "$program" sweep both.yaml --jobs 1 > main.txt 2>&1 & main=$!
    until "$program" sweep both.yaml --list | grep -q '^2 .*running'; do kill -0 $main 2> err.txt || break; done
    kill -STOP $main && pgrep -P $main > out.txt
}
until try_both; do
    kill -CONT "$child" $main
    wait $pid || { echo "both cannot be held"; exit 1; }
    wait $main
done
kill -CONT "$child"; wait $pid; is "the other one" $? 0
kill -CONT $main; wait $main; is "the sweep" $? 0
cp main.txt out.txt; says "run 1 was done elsewhere"; says "2 done"; says "0 under way elsewhere"

# ---- A cluster gets what is neither with it, nor under way, nor at its end, when it is asked ----
mkdir bin
echo 'echo "MaxArraySize = 4"' > bin/scontrol
printf '%s\n' '[ ! -x ./meanwhile ] || ./meanwhile > meanwhile.txt 2>&1' 'cat queue.txt' > bin/squeue
cat > bin/sbatch <<'END'
for word; do case $word in --job-name=*) name=${word#*=} ;; --array=*) array=${word#*=} ;; esac; done
echo "$array of ${name##*+}" >> submitted.txt
echo "$array" | tr , '\n' | while IFS=- read -r from to; do seq "$from" "${to:-$from}" | sed "s/^/$name /"; done >> queue.txt
END
for tool in scontrol squeue sbatch; do sed -i '1i #!/bin/sh' bin/$tool; chmod +x bin/$tool; done
: > queue.txt
submit() { # a sweep; what it says
    PATH="$work/bin:$PATH" expect 0 "$program" sweep "$1" --slurm; says "^$2$"
}
sweep tasks 'vary: {shell.thickness: [1 mm, 2 mm, 3 mm, 4 mm, 5 mm, 6 mm]}'
"$program" sweep tasks.yaml --index 2 --quiet
submit tasks.yaml "5 runs submitted, 0 are with Slurm already, 0 are under way elsewhere, 1 have ended"
is arrays "$(paste -sd';' submitted.txt)" "1,3 of 0;1-3 of 3"
submit tasks.yaml "0 runs submitted, 5 are with Slurm already, 0 are under way elsewhere, 1 have ended"
cat > meanwhile <<END
#!/bin/sh
for run in 1 3 4; do "$program" sweep tasks.yaml --index \$run; done
sed -i '1,3d; \$d' queue.txt # those, and run 6, which was killed
END
chmod +x meanwhile
submit tasks.yaml "1 runs submitted, 1 are with Slurm already, 0 are under way elsewhere, 4 have ended"
is again "$(tail -1 submitted.txt)" "3 of 3"
rm meanwhile; : > queue.txt
hold parts
submit parts.yaml "1 runs submitted, 0 are with Slurm already, 1 are under way elsewhere, 0 have ended"
kill -KILL $pid "$child"; wait $pid 2> err.txt

# ---- Files that the scene names, or what is varied, are each run's own ----
sweep drawn "vary: {zip: true, spline.iterations: [1, 2], output.hpgl: [a.plt, '../plots/it''s: b.plt']}"
{ cat "$here/scene_draw.yaml"; echo 'output: {gcode: plot.gcode}'; } > drawing.yaml
sed -i 's/strip.yaml/drawing.yaml/' drawn.yaml
expect 3 "$program" sweep drawn.yaml; says "drawing.yaml: the folder 'drawn/../plots/', where .output. has files, is not there"
is "sentences" "$(wc -l < err.txt)" 1; [ ! -e drawn ] || { echo "a folder is left of what has not begun"; bad=1; }
mkdir plots
"$program" sweep drawn.yaml --index 1 --quiet
: > queue.txt
submit drawn.yaml "1 runs submitted, 0 are with Slurm already, 0 are under way elsewhere, 1 have ended"
"$program" sweep drawn.yaml --quiet
for run in 1 2; do exists drawn/000${run}_plot.gcode; exists drawn/000$run.svg; done
exists drawn/0001_a.plt; exists "plots/0002_it's: b.plt"
expect 0 "$program" export drawn/0002.vtkhdf -o last.gcode; same last.gcode drawn/0002_plot.gcode
touch -d 2001-01-01 drawn/000*.vtkhdf
"$program" sweep drawn.yaml --quiet
is "drawings kept" "$(find drawn -name '000*.vtkhdf' ! -newermt 2001-01-02 | wc -l)" 2

exit $bad
