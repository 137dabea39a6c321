#!/bin/sh
# The program starts itself again for kernels that this processor deserves, once; and says which it has.
#   tests/kernels.sh PROGRAM SHIM        SHIM: another machine (machine_shim.c)
. "$(dirname "$0")/expect.sh"
shim=$2
unset OPENBLAS_CORETYPE OPENBLAS_NUM_THREADS
has() { for flag in "$@"; do grep -qw "$flag" /proc/cpuinfo || return 1; done; }
best=Prescott
has avx2 fma && best=Haswell
has avx2 fma avx512f avx512cd avx512bw avx512dq avx512vl && best=SkylakeX

expect 0 "$program" --version; says "^kernels [A-Z]"
[ $best = Prescott ] || ! grep -q "^kernels Prescott" out.txt || { echo "the oldest kernels on a newer processor"; bad=1; }
expect 0 env OPENBLAS_CORETYPE=Prescott "$program" --version; says "^kernels Prescott"
[ $best = Prescott ] || says "slow: OPENBLAS_CORETYPE says so; this processor has those of $best"

# A library that knows no processor is told; one that is told by the user, or does not listen, is left at that.
expect 0 env LD_PRELOAD="$shim" "$program" --version; says "^kernels $best\$"
expect 0 env LD_PRELOAD="$shim" OPENBLAS_CORETYPE=Nehalem "$program" --version; says "^kernels Nehalem"
expect 0 env LD_PRELOAD="$shim" KERNELS_DEAF=1 "$program" --version; says "^kernels Prescott"

# The program that goes on is the one that was asked: same arguments, same exit code, same process.
expect 2 env LD_PRELOAD="$shim" "$program" fly "two words"; says "no verb 'fly'"
LD_PRELOAD=$shim "$program" run "$here/scene_small.yaml" --set design.iterations=100000 --set design.tolerance=0 --quiet --no-picture -o live & pid=$!
until "$program" info live.run 2> err.txt | grep -q objective; do sleep 0.1; kill -0 $pid || break; done
kill -INT $pid; wait $pid; code=$?
[ $code = 75 ] || { echo "Ctrl-C ends with $code"; bad=1; }

# The result names them, and a run that goes on with others says so.
expect 0 "$program" info live.vtkhdf; says "OpenBLAS's kernels: $best"
expect 0 env OPENBLAS_CORETYPE=Prescott "$program" run "$here/scene_small.yaml" --quiet --no-picture -o two --set design.iterations=2
expect 0 env LD_PRELOAD="$shim" OPENBLAS_CORETYPE=Nehalem "$program" run "$here/scene_small.yaml" --quiet --no-picture -o two --resume --set design.iterations=3
says "warning: this run was begun with OpenBLAS's kernels Prescott and goes on with Nehalem"; says "OPENBLAS_CORETYPE=Prescott keeps"
expect 0 "$program" info two.vtkhdf; says "OpenBLAS's kernels: Prescott, Nehalem"
expect 0 env OPENBLAS_CORETYPE=Prescott "$program" run "$here/scene_small.yaml" --quiet --no-picture -o one --set design.iterations=2
expect 0 env OPENBLAS_CORETYPE=Prescott "$program" run "$here/scene_small.yaml" --quiet --no-picture -o one --resume --set design.iterations=3
! grep -q kernels err.txt || { echo "the same kernels are warned of:"; cat err.txt; bad=1; }
expect 0 "$program" check "$here/scene_small.yaml"; says "OpenBLAS's kernels: "

# Threads: as many as there are processors, where there are more than are of use, or nobody knows how many.
for processors in 1 128 -1; do
    expect 0 env LD_PRELOAD="$shim" PROCESSORS=$processors "$program" run "$here/scene_small.yaml" --quiet --no-picture -o many --force --set design.iterations=1
done

# Little memory: an end and a sentence, with a code of its own, never a library that asks for ever; what was there stays.
for limit in 130000 200000 260000; do
    expect 0 "$program" run "$here/scene_small.yaml" --quiet --no-picture -o little --force --set design.iterations=1
    cp little.vtkhdf before.vtkhdf
    (ulimit -v $limit && exec timeout -s KILL 60 "$program" run "$here/scene_small.yaml" --set shell.mesh.n=60 --quiet --no-picture --force -o little) > out.txt 2> err.txt
    code=$?
    [ $code = 5 ] || { echo "with $limit kB it ends with $code"; cat err.txt; bad=1; }
    says "slender: out of memory"
    cmp -s little.vtkhdf before.vtkhdf || { echo "with $limit kB the old result is lost"; bad=1; }
done

# Room for fewer threads than are asked for, and little of it for each: fewer work, and it goes on.
(ulimit -v 330000 && exec "$program" run "$here/scene_small.yaml" --threads 5 --quiet --no-picture -o fewer --set design.iterations=1) ||
    { echo "with room for one thread it ends with $?"; bad=1; }
(ulimit -s 128 && exec "$program" run "$here/scene_small.yaml" --threads 5 --set shell.mesh.n=24 --quiet --no-picture -o low --set design.iterations=1) ||
    { echo "with a small stack it ends with $?"; bad=1; }
exit $bad
