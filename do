#!/bin/sh
# The project's commands: each installs what is missing, then does its work.
#   ./do setup            install the Debian packages that slender needs
#   ./do build            Release build in build/
#   ./do run SCENE ..     build, then run a scene (options: build/slender run --help)
#   ./do test [NAME ..]   build, then run all tests (or those whose name matches one)
#   ./do bench [NAME ..]  build, then measure (bench/README.md)
#   ./do verify [NAME ..] build, then run published cases (docs/verification.md, which all of them rewrite)
#   ./do deb              a Debian package in build-deb/, for any processor of this kind (docs/packages.md)
#   ./do wheel            the Python package in python/dist/: a wheel, and an sdist
set -eu
here=$(pwd) # scenes and results are where the user is
cd "$(dirname "$0")"
root=$(pwd)

packages="gcc cmake make pkg-config libsuitesparse-dev libopenblas-dev libnlopt-dev libmuparser-dev libcairo2-dev
          libyaml-dev libsqlite3-dev libhdf5-dev libwebp-dev libjpeg-dev zlib1g-dev libexpat1-dev fonts-dejavu-core libcmocka-dev"
tools="clang-format-14 python3-h5py chromium" # of tests that are skipped without
wheel="python3-setuptools python3-wheel python3-numpy"

# Runs a command without a word, unless it fails.
quietly() {
    "$@" > build.log 2>&1 || { cat build.log; exit 1; }
    rm -f build.log
}

setup() { # packages
    missing=""
    for package in "$@"; do
        dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    echo "slender needs, and installs:$missing"
    sudo=""
    [ "$(id -u)" = 0 ] || sudo=sudo
    quietly $sudo apt-get update
    # shellcheck disable=SC2086
    quietly $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
}

build() {
    # shellcheck disable=SC2086
    setup $packages
    quietly cmake --preset release
    if [ "${1:-}" = quiet ]; then
        [ -x build/slender ] || echo "building slender: a minute, this once"
        quietly cmake --build build -j"$(nproc)" --target slender
    else
        cmake --build build -j"$(nproc)"
    fi
}

command=${1:-help}
[ $# -eq 0 ] || shift
case $command in
setup) setup $packages ;;
build) build ;;
run)
    case ${1:-} in # a minute of building is long for a misspelt name
    -* | /* | "") ;;
    *) [ -e "$here/$1" ] || { echo "slender: $1: there is no such file in $here" >&2; exit 3; } ;;
    esac
    build quiet
    cd "$here"
    exec "$root/build/slender" run "$@"
    ;;
bench)
    build > /dev/null
    cd build && exec bench/bench "$@"
    ;;
verify)
    setup python3-h5py
    build quiet
    exec /usr/bin/python3 verify/verify.py build/slender --page docs/verification.md "$@"
    ;;
test)
    build
    (setup $tools) || echo "tests that need them are skipped"
    names=$(IFS='|'; echo "$*")
    ctest --test-dir build --output-on-failure ${names:+-R "$names"}
    ;;
wheel)
    # shellcheck disable=SC2086
    setup $packages $wheel
    cd python
    rm -rf build/lib build/bdist* dist
    quietly /usr/bin/python3 setup.py bdist_wheel sdist
    ls dist/*
    ;;
deb)
    # shellcheck disable=SC2086
    setup $packages dpkg-dev file
    quietly cmake -B build-deb -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_FLAGS_RELEASE=-O3 -DCMAKE_INSTALL_PREFIX=/usr -DSLENDER_NATIVE=OFF -DSLENDER_TESTS=OFF
    quietly cmake --build build-deb -j"$(nproc)"
    cd build-deb
    rm -f ./*.deb
    quietly cpack
    ls "$PWD"/*.deb
    ;;
*) sed -n '2,10s/^# \{0,1\}//p' do ;;
esac
