#!/bin/sh
# The wheel and the sdist that `./do wheel` left, each installed into a fresh environment, without network, and tested there:
# some minutes, since the sdist is compiled.
tests=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
unset SLENDER_LIBRARY PYTHONPATH
bad=0
for file in "$tests"/../dist/slender-*.whl "$tests"/../dist/slender-*.tar.gz; do
    echo "$(basename "$file")"
    rm -rf "$scratch/env"
    /usr/bin/python3 -m venv --system-site-packages "$scratch/env" || exit 1
    "$scratch/env/bin/pip" install --no-index --no-build-isolation "$file" > "$scratch/log" 2>&1 || { tail -30 "$scratch/log"; exit 1; }
    package=$(cd "$scratch" && env/bin/python -c "import slender; print(slender.__path__[0])")
    case $package in "$scratch"/*) ;; *) echo "another package is found: $package"; bad=1 ;; esac
    (cd "$tests" && SLENDER_PACKAGE=$(dirname "$package") PYTHONDONTWRITEBYTECODE=1 "$scratch/env/bin/python" -m unittest) || bad=1
done
exit $bad
