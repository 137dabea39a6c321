#!/bin/sh
# A sweep by a Slurm of its own on this machine, whose daemons, tasks and submitters are killed at random: every run ends
# once. As root, with Debian's slurm-wlm; minutes, so no part of the tests.
#   tests/slurm_loopback.sh PROGRAM [RUNS [SUBMITTERS [ARRAY]]]      1000 runs, 100 killed submitters, arrays of 300
program=$(realpath "$1"); runs=${2:-1000}; submitters=${3:-100}; array=${4:-301}
work=$(mktemp -d /tmp/slurm.XXXXXX) && cd "$work" || exit 2
chmod 755 "$work"
host=$(hostname -s); export SLURM_CONF="$work/slurm.conf"
cat > slurm.conf <<END
ClusterName=loop
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
SlurmctldPort=17817
SlurmdPort=17818
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=batch_sched_delay=0,sched_interval=2,sched_min_interval=100000
MaxArraySize=$array
MaxJobCount=5000
JobRequeue=1
MinJobAge=2
ReturnToService=2
SlurmctldTimeout=300
SlurmdTimeout=300
KillWait=5
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
END
mkdir state spool
dd if=/dev/urandom of=munge.key bs=128 count=1 2> err.txt; chmod 400 munge.key
munged --force --foreground --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munged.pid" \
    --log-file="$work/munged.log" --seed-file="$work/munged.seed" > munged.out 2>&1 & munged=$!
sleep 1
slurmctld -D -c > slurmctld.out 2>&1 & controller=$!
slurmd -D -N "$host" > slurmd.out 2>&1 & node=$!
finish() {
    scancel --user=root 2> err.txt; sleep 2
    kill $node $controller $munged 2> err.txt; wait 2> err.txt
    [ -n "$KEEP" ] || rm -rf "$work"
}
trap finish EXIT
for _ in $(seq 60); do sinfo -h -o %T 2> err.txt | grep -q idle && break; sleep 1; done
sinfo || { cat slurmctld.out slurmd.out; exit 1; }

cat > strip.yaml <<'END'
slender: 1
job: equilibrium
shell: {mesh: {shape: sheet, size: [20 mm, 5 mm], cells: [4, 1]}, thickness: 1 mm, young: 1 MPa, poisson: 0.4, density: 1000 kg/m^3, gravity: [0, 0, -9.81]}
fix: [{group: root, clamp: true}]
END
{ echo shell.young; for k in $(seq "$runs"); do echo "$((k + 1000)) kPa"; done; } > runs.csv
printf 'sweep: 1\nscene: strip.yaml\nvary: {file: runs.csv}\ncollect: [final/energy/bending]\n' > s.yaml
cp s.yaml here.yaml
queued() { squeue --noheader --array --format='%j %K' 2> err.txt; }
random() { od -An -N2 -tu2 /dev/urandom | tr -d ' '; }

# ---- Submitters that are killed ----
scontrol update partition=all state=down # nothing starts until all have been killed
began=$(date +%s.%N)
for _ in $(seq "$submitters"); do
    "$program" sweep s.yaml --slurm > submit.txt 2>&1 & pid=$!
    sleep "$(awk -v r="$(random)" 'BEGIN { printf "%.3f", 3 * r / 65536 }')"
    kill -9 $pid 2> err.txt; wait $pid 2> err.txt
done
for _ in $(seq 30); do "$program" sweep s.yaml --slurm > submit.txt 2>&1 && break; sleep 1; done
cat submit.txt
echo "killed submitters: $submitters, $(date +%s.%N | awk -v b="$began" '{ printf "%.0f s", $1 - b }')"
queued > queued.txt
echo "tasks queued: $(wc -l < queued.txt), different: $(sort -u queued.txt | wc -l), of $runs"
"$program" sweep s.yaml --slurm

# ---- Tasks and the controller that are killed ----
scontrol update partition=all state=up
began=$(date +%s.%N); killed=0; restarts=0
mend() { # what an administrator does after such a controller: nodes that it mistrusts, tasks that it holds
    ! sinfo -h -o %T 2> err.txt | grep -qE "drain|down" || scontrol update nodename="$host" state=resume 2> err.txt
    for task in $(squeue --noheader --array --format='%i %r' 2> err.txt | awk '/[Hh]eld/ { print $1 }'); do scontrol release "$task" 2> err.txt; done
}
while [ -n "$(queued)" ] || ! kill -0 $controller 2> err.txt; do
    sleep 0.5; mend
    r=$(random)
    if [ $((r % 100)) = 0 ]; then
        kill -9 $controller 2> err.txt; wait $controller 2> err.txt; restarts=$((restarts + 1))
        slurmctld -D > slurmctld.out 2>&1 & controller=$!
        until scontrol ping 2> err.txt | grep -q UP; do sleep 0.3; done
    elif [ "$(queued | wc -l)" -lt 20 ]; then # the last ones would never end
        sleep 1
    elif [ $((r % 3)) = 0 ]; then
        job=$(squeue --noheader --states=running --format=%i 2> err.txt | shuf -n 1)
        [ -z "$job" ] || { scontrol requeue "$job" 2> err.txt && killed=$((killed + 1)); }
    elif [ $((r % 3)) = 1 ]; then # a task and its run, at once
        job=$(squeue --noheader --states=running --format=%A 2> err.txt | shuf -n 1)
        [ -z "$job" ] || { scancel --signal=KILL --full "$job" 2> err.txt && killed=$((killed + 1)); }
    fi
done
echo "tasks requeued or killed: $killed, controllers killed: $restarts, $(date +%s.%N | awk -v b="$began" '{ printf "%.0f s", $1 - b }')"
"$program" sweep s.yaml --list | awk '{ print $NF }' | sort | uniq -c
for _ in 1 2 3; do # what was killed for good is submitted again
    "$program" sweep s.yaml --slurm -- --quiet
    while [ -n "$(queued)" ]; do sleep 1; mend; done
done

# ---- Every run once, none twice ----
"$program" sweep s.yaml --collect
awk -F, 'NR > 1 { n[$1]++; s[$3]++ } END { for (k in n) if (n[k] != 1) print "row " k " " n[k] " times"; for (k in s) print s[k], k }' s.csv
grep -ho 'run [0-9]* done' s/slurm-*.log > done.txt
computed=$(wc -l < done.txt) different=$(sort -u done.txt | wc -l)
echo "computed to the end: $computed, different: $different"
began=$(date +%s.%N)
"$program" sweep here.yaml --quiet
echo "here alone: $(date +%s.%N | awk -v b="$began" '{ printf "%.0f s", $1 - b }')"
cmp s.csv here.csv && echo "the same table" && [ "$computed $different" = "$runs $runs" ]
