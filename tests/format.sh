#!/bin/sh
# Sources are laid out as .clang-format says, by the clang-format of Debian 12: others lay out a little otherwise.
#   tests/format.sh SOURCE; skipped (77) without it. To mend: clang-format -i */*.[ch] */*/*.[ch]
cd "$1" || exit 2
program=$(command -v clang-format-14 || command -v clang-format) && "$program" --version | grep -q 'version 14\.' ||
    { echo "no clang-format 14 here"; exit 77; }
ls ./*/*.[ch] ./*/*/*.[ch] | grep -v "^./build" | xargs "$program" --dry-run --Werror # what a build has made is for no reader
