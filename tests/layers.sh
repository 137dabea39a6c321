#!/bin/sh
# Fails where an include breaks the picture in docs/README.md.
cd "$1" || exit 2
bad=0
check() { # folder, folders it may include
    found=$(grep -Hn '#include "[a-z]*/' "$1"/*.c "$1"/*.h 2>/dev/null | grep -Ev "#include \"($2)/")
    [ -z "$found" ] || { echo "$1/ may include only $2:"; echo "$found"; bad=1; }
}
check base 'base'
check solve 'base|solve'
check io 'base|io'
check field 'base|solve|io|field'
check shell 'base|solve|io|field|shell'
check rod 'base|solve|io|field|rod'
check spline 'base|solve|io|spline'
check optim 'base|solve|optim'
exit $bad
