#!/bin/sh
# The package's types, by mypy --strict; and files of at most 500 lines, but for scene_types.py, which a program writes. Skipped (77) without mypy.
#   python/tests/types.sh BUILD     for mypy's cache: without it torch takes it a minute
cache=$(cd "$1" && pwd)/mypy || exit 1
cd "$(dirname "$0")/.." || exit 1
bad=0
for file in *.py */*.py; do
    [ "$file" != slender/scene_types.py ] || continue
    lines=$(wc -l < "$file")
    [ "$lines" -le 500 ] || { echo "python/$file has $lines lines; 500 is the limit"; bad=1; }
done
for python in ${PYTHON:+"$PYTHON"} /usr/bin/python3 python3; do
    "$python" -c "import mypy, numpy, torch" 2> /dev/null || continue
    "$python" -m mypy --strict --cache-dir "$cache" slender make_scene_types.py || bad=1
    exit $bad
done
[ $bad = 1 ] && exit 1
echo "no Python with mypy, numpy and torch here"
exit 77
