#!/bin/sh
# Some of the quickest cases of ./do verify, so that it keeps working; skipped without h5py.    tests/verify.sh PROGRAM
/usr/bin/python3 -c 'import h5py' 2> /dev/null || exit 77
verify=$(dirname "$0")/../verify/verify.py
/usr/bin/python3 -B "$verify" "$1" --jobs 2 "Sze 3.1" "column, force" "cylinder magnet, off" "uniaxial stretch, neo_hookean, nu" "slope of 0.7" "spring by" || exit 1
! /usr/bin/python3 -B "$verify" "$1" --jobs 1 "no such case" 2> /dev/null || { echo "a name that no case has is not refused"; exit 1; }
# A program that has no result is told, and fails.
! /usr/bin/python3 -B "$verify" /bin/false "spring by" > /dev/null || { echo "a run that fails passes"; exit 1; }
