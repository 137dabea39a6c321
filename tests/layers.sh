#!/bin/sh
# Fails where an include breaks the picture in docs/README.md.
cd "$1" || exit 2
bad=0
check() { # folder, folders it may include (a front is no part of its body's folder)
    found=$(grep -Hn '#include "[a-z]*/' "$1"/*.c "$1"/*.h 2>/dev/null | grep -Ev "#include \"($2)/[a-z_0-9]*\.h\"")
    [ -z "$found" ] || { echo "$1/ may include only $2:"; echo "$found"; bad=1; }
}
check base 'base'
check solve 'base|solve'
check io 'base|io'
check optim 'base|solve|optim'
check surface 'base|solve|io|surface'
check shell 'base|solve|io|surface|shell'
check rod 'base|solve|io|surface|rod'
check spline 'base|solve|io|spline'
bodies='base|solve|io|surface|optim|model|job'
check shell/front "$bodies|shell|shell/front"
check rod/front "$bodies|rod|rod/front"
check spline/front "$bodies|spline|spline/front"
exit $bad
