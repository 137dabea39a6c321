#!/bin/sh
# Exported files, read with a Python that has numpy; skipped (77) without one.    tests/exports.sh PROGRAM
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
export PYTHONDONTWRITEBYTECODE=1
for python in ${PYTHON:+"$PYTHON"} /usr/bin/python3 python3; do
    "$python" -c "import numpy" 2> /dev/null || continue
    "$python" "$here/exports.py" "$program"
    exit $?
done
echo "no Python with numpy here"
exit 77
