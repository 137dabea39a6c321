#!/bin/sh
# The Debian package: what is in it, its man page and completion; skipped (77) where there is no dpkg.
#   tests/packages.sh BUILD
build=$(cd "$1" && pwd) || exit 1
for tool in cpack dpkg-deb dpkg-shlibdeps file; do command -v $tool > /dev/null || { echo "no $tool here"; exit 77; }; done
. "$(dirname "$0")/expect.sh"

expect 0 cpack --config "$build/CPackConfig.cmake" -B "$work/pack" -D CPACK_DEBIAN_COMPRESSION_TYPE=none
expect 0 dpkg-deb -x pack/*.deb x
version=$("$build/slender" version | sed -n 's/^slender //p')
[ "$(dpkg-deb -f pack/*.deb Version | cut -d- -f1)" = "$version" ] || { echo "it is of another version"; bad=1; }
for needed in libcholmod3 libhdf5 libopenblas0 libwebp fonts-dejavu-core; do
    dpkg-deb -f pack/*.deb Depends | grep -q $needed || { echo "it does not need $needed"; bad=1; }
done
for file in bin/slender include/slender.h 'lib/*libslender.so.0' 'lib/*libslender.a' 'lib/*pkgconfig/slender.pc' 'lib/*cmake/slender/slenderConfig.cmake' \
    share/man/man1/slender.1.gz share/bash-completion/completions/slender share/doc/slender/copyright share/doc/slender/changelog.Debian.gz \
    share/doc/slender/examples/hexagram.yaml share/doc/slender/examples/meshes/reptile.obj lib/python3/dist-packages/slender/py.typed; do
    find x/usr -path "x/usr/$file" -o -path "x/usr/${file#*/\*}" | grep -q . || { echo "usr/$file is not in it"; bad=1; }
done
[ "$(find x -name '*.pyc' -o -name '*.vtkhdf' | wc -l)" = 0 ] || { echo "what is made is in it"; bad=1; }
expect 0 x/usr/bin/slender run x/usr/share/doc/slender/examples/rod_helix.yaml --quiet --no-picture -o helix

# The man page has all verbs and options, each as an entry of its list or in how the verb is used.
gzip -dc x/usr/share/man/man1/slender.1.gz > slender.1
verbs=$("$build/slender" help | sed -n 's/^  slender \([a-z]*\) .*/\1/p')
[ "$verbs" ] && [ "$(sed -n 's/^\.SS //p' slender.1)" = "$verbs" ] || { echo "the man page has other verbs than" $verbs; bad=1; }
for verb in $verbs; do
    awk -v heading=".SS $verb" '/^\.S[SH]/ { on = $0 == heading } on' slender.1 | sed 's/\\-/-/g' > part.txt
    for option in $("$build/slender" "$verb" --options | sed -n 's/^\(--[a-z-]*\) - .*/\1/p; s/^--[a-z-]* \(-[a-z]\) .*/\1/p'); do
        grep -q -e "$option" part.txt || { echo "the man page has no $option of $verb"; bad=1; }
    done
done
! grep -n '^\\-' slender.1 || { echo "an option is no entry of its list"; bad=1; }
! command -v groff > /dev/null || { expect 0 groff -man -ww -z slender.1; [ ! -s err.txt ] || { cat err.txt; bad=1; }; }

# Completion: the words after these.
PATH="$work/x/usr/bin:$PATH"
cat > completes.bash <<'END'
. x/usr/share/bash-completion/completions/slender
COMP_WORDS=(slender "$@") COMP_CWORD=$#
_slender slender
printf '%s\n' "${COMPREPLY[@]}"
END
completes() { # word that is offered, words of the line ..
    offer=$1; shift
    expect 0 bash completes.bash "$@"; grep -q -x -e "$offer" out.txt || { echo "'$*' does not offer $offer:"; cat out.txt err.txt; bad=1; }
}
offers_only() { # words that are offered, apart by blanks; words of the line ..
    offer=$1; shift
    expect 0 bash completes.bash "$@"; [ "$(tr '\n' ' ' < out.txt)" = "$offer " ] || { echo "'$*' offers not only $offer:"; cat out.txt err.txt; bad=1; }
}
touch 'a b.yaml' other.txt '$(touch run).yaml'
# shellcheck disable=SC2086
offers_only "$(echo $verbs)" ""
for verb in run picture; do
    # shellcheck disable=SC2046
    offers_only "$(echo $("$build/slender" $verb --options | sed -n 's/^\(--[a-z-]*\) .*/\1/p') --help)" $verb --
done
offers_only picture pi
completes 'a b.yaml' run ""
! grep other out.txt || { echo "a text is no scene"; bad=1; }
offers_only 'a b.yaml' run --force a
offers_only design run --set job = des
offers_only "shell.thickness. shell.thickness=" run --set shell.thi
completes 'fix\[0\].ball.' run --set 'fix[0].'
offers_only json run --log = j
offers_only over picture helix.vtkhdf --target o
offers_only helix.vtkhdf info helix.v
completes rod/x export helix.vtkhdf --dataset ""
expect 0 slender run "$here/scene_small.yaml" --set shell.mesh.n=2 --set design.iterations=0 --quiet --no-picture -o star
completes von_mises picture star.vtkhdf --field ""
offers_only "down up" picture star.vtkhdf --case ""
expect 0 bash -c '. x/usr/share/bash-completion/completions/slender; _slender_values FILE; [[ ${#COMPREPLY[@]} = 0 ]]' # another word for a file
[ ! -e run ] || { echo "the name of a file was run"; bad=1; }

# Python finds the package's library.
! /usr/bin/python3 -c "import numpy" 2> /dev/null || {
    library=$(find "$work/x/usr/lib" -name libslender.so.0)
    expect 0 env PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$work/x/usr/lib/python3/dist-packages" LD_LIBRARY_PATH="${library%/*}" /usr/bin/python3 -c "
import slender
print(slender.__file__, slender.versions())"; says "$work/x/usr/lib/python3/dist-packages/slender"
}
exit $bad
