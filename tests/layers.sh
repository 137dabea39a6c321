#!/bin/sh
# Fails where an include breaks the picture in docs/README.md, or a file asks what kind of body a model has.
cd "$1" || exit 2
bad=0
check() { # folder, folders it may include (a front is no part of its body's folder)
    found=$(grep -Hn '#include "[a-z]*/' "$1"/*.c "$1"/*.h 2>/dev/null | grep -Ev "#include \"($2)/[a-z_0-9]*\.h\"")
    [ -z "$found" ] || { echo "$1/ may include only $2:"; echo "$found"; bad=1; }
}
fronts=$(ls -d */front) # a body is a folder with one
bodies=$(echo $fronts | sed 's#/front##g; s/ /|/g')
physics='base|solve|io|field|surface'
check base 'base'
check solve 'base|solve'
check io 'base|io'
check field 'base|solve|io|field'
check optim 'base|solve|optim'
check surface "$physics"
check world "$physics|world"
physics="$physics|world"
check model "$physics|optim|model"
check job "$physics|optim|model|job"
for front in $fronts; do
    body=${front%/front}
    check "$body" "$physics|$body"
    check "$front" "$physics|optim|model|job|$body|$front"
done
check view 'base|io|spline|view'
check export 'base|io|field|view|export'
check report 'base|io|spline|model|view|report'
check lib "$physics|optim|model|job|lib|[a-z]*/front"
check sweep "$physics|optim|model|job|sweep"
check cli "$physics|optim|model|job|lib|view|export|report|sweep|cli|spline"

# What is not alike for bodies and jobs is in their rows (model/rows.h).
for folder in base solve io field optim surface world model job view export report lib sweep cli; do
    found=$(grep -HnE "(->|\.)($bodies|drawing)\b[^/\"]|\b(JOB|BODY)_[A-Z]" $folder/*.[ch] | grep -v '#include')
    [ -z "$found" ] || { echo "$folder/ asks for the kind of a body or job:"; echo "$found"; bad=1; }
done
found=$(grep -nE "[!=]= *&job_[a-z]+" */*.[ch] */front/*.[ch])
[ -z "$found" ] || { echo "a job of all bodies is asked for, where its row should say (model/rows.h):"; echo "$found"; bad=1; }
! grep -n '#include "' include/slender.h || { echo "include/slender.h stands alone"; bad=1; }
exit $bad
