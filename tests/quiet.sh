#!/bin/sh
# Below cli/ nothing ends the process, catches a signal, sets anything for all of it, or prints: it may be somebody else's.
#   tests/quiet.sh ARCHIVE ...        the objects of the folders, by what they ask of other libraries
ends='_?_?exit|_Exit|quick_exit|abort|raise|kill|exec[lv][a-z]*|v?fork|system|popen|atexit'
sets='signal|sigaction|sigprocmask|pthread_sigmask|setenv|unsetenv|putenv|clearenv|setlocale|umask|chdir|setrlimit|srand|fesetround'
blas='openblas_set_num_threads|goto_set_num_threads|kernels_start|kernels_one_thread'
prints='stdout|stderr|(__)?v?printf(_chk)?|puts|putchar|perror|psignal'
bad=0
for archive in "$@"; do
    asked=$(nm -A --undefined-only "$archive") && [ -n "$asked" ] || { echo "$archive cannot be read"; exit 1; }
    found=$(echo "$asked" | grep -E " ($ends|$sets|$blas|$prints)(@.*)?\$" | grep -v 'slender_sweep\.a:work\.c\.o: *U kill$') # of its runs
    [ -z "$found" ] || { echo "not quiet:"; echo "$found"; bad=1; }
done
exit $bad
