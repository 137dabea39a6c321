# What tests of the program share: sourced with its path as $1; leaves $program, $here, a folder of its own, and $bad.
# shellcheck shell=sh
program=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 2
bad=0
expect() { # exit code, command ..
    wanted=$1; shift
    "$@" > out.txt 2> err.txt
    code=$?
    [ $code = "$wanted" ] && return
    echo "$* ends with $code, not $wanted"; cat out.txt err.txt; bad=1
}
says() { grep -q -- "$1" out.txt err.txt || { echo "nothing says '$1':"; cat out.txt err.txt; bad=1; }; }
exists() { [ -s "$1" ] || { echo "$1 is missing or empty"; bad=1; }; }
same() { cmp -s "$1" "$2" || { echo "$1 and $2 differ"; bad=1; }; }
