#!/bin/sh
# What `slender sweep --slurm` asks of Slurm's programs: stand-ins, which write down how they are called, take their places.
# Slurm itself: tests/slurm_loopback.sh.    tests/sweep_slurm.sh PROGRAM
. "$(dirname "$0")/expect.sh"
cat > strip.yaml <<'END'
slender: 1
job: equilibrium
shell: {mesh: {shape: sheet, size: [20 mm, 5 mm], cells: [4, 1]}, thickness: 1 mm, young: 1 MPa, poisson: 0.4}
fix: [{group: root, clamp: true}]
END
printf 'sweep: 1\nscene: strip.yaml\nvary: {shell.thickness: [1 mm, 2 mm, 3 mm, 4 mm, 5 mm, 6 mm, 7 mm, 8 mm]}\n' > s.yaml
mkdir bin
cat > bin/scontrol <<'END'
#!/bin/sh
echo "MaxArraySize            = 4"
END
cat > bin/squeue <<'END'
#!/bin/sh
cat "$QUEUE"
END
cat > bin/sbatch <<'END'
#!/bin/sh
for word; do case $word in *=*/*) ;; --job-name=*+*) echo "--job-name=+${word##*+}" ;; */*) ;; *) echo "$word" ;; esac; done | tr '\n' ' ' >> "$CALLS"
echo >> "$CALLS"
END
chmod +x bin/*
export PATH="$work/bin:$PATH" QUEUE="$work/queue" CALLS="$work/calls"

# Eight runs in arrays of three tasks each, whose numbers begin with 1; the offset goes to the job, too.
: > queue
expect 0 "$program" sweep s.yaml --slurm -- --time=5; says "8 runs submitted, 0 are with Slurm already"
cat > wanted <<'END'
--time=5 --job-name=+0 --array=1-3 0 
--time=5 --job-name=+3 --array=1-3 3 
--time=5 --job-name=+6 --array=1-2 6 
END
same calls wanted

# What Slurm has is not submitted again.
printf 'slender-s-0+0 2\nslender-s-0+3 1\nslender-s-0+3 2\nslender-s-0+3 3\nnoise\n' > queue
: > calls
expect 0 "$program" sweep s.yaml --slurm; says "4 runs submitted, 4 are with Slurm already"
printf '%s \n' '--job-name=+0 --array=1,3 0' '--job-name=+6 --array=1-2 6' > wanted
same calls wanted

# Options of sbatch reach it, however many they are.
: > queue; : > calls
set --; for k in $(seq 100); do set -- "$@" "--option=$k"; done
expect 0 "$program" sweep s.yaml --slurm -- "$@"
[ "$(head -1 calls | wc -w)" = 103 ] || { echo "not all options:"; head -1 calls; bad=1; }

# What a program of Slurm's says when it fails is said.
printf '#!/bin/sh\necho no such partition\nexit 1\n' > bin/sbatch
expect 4 "$program" sweep s.yaml --slurm; says "Slurm's sbatch failed: no such partition"
exit $bad
