#!/bin/sh
# The package's tests, with a Python that has numpy; skipped (77) without one, or without the library.
#   python/tests/run.sh BUILD [TEST ..]     $PYTHON: another Python than these
tests=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd) || exit 1
shift
export SLENDER_LIBRARY="$build/libslender.so" SLENDER_SHIM="$build/tests/libmachine_shim.so" PYTHONDONTWRITEBYTECODE=1
[ -e "$SLENDER_LIBRARY" ] || { echo "no $SLENDER_LIBRARY here"; exit 77; }
for python in ${PYTHON:+"$PYTHON"} /usr/bin/python3 python3; do
    "$python" -c "import numpy" 2> /dev/null && cd "$tests" && exec "$python" -m unittest "${@:-discover}"
done
echo "no Python with numpy here"
exit 77
