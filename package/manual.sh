#!/bin/sh
# The man page, made of what the program says of itself.    package/manual.sh PROGRAM > slender.1
set -eu
program=$1

# Lines of --help as roff: how it is used as they are, options with what they do as a list, other lines as paragraphs.
page='
function plain(s) { gsub(/\\/, "\\e", s); gsub(/-/, "\\-", s); gsub(/\047/, "\\(aq", s); return s }
function text(s,    words, count, k, line) { # in lines of less than 80 letters
    if (paragraph) print ".PP"
    paragraph = 0
    count = split(plain(s), words, " ")
    for (k = 1; k <= count; k++) {
        if (line != "" && length(line words[k]) > 76) { put(line); line = "" }
        line = line (line == "" ? "" : " ") words[k]
    }
    put(line)
}
function put(line) { print (line ~ /^\./ ? "\\&" : "") line }
/^usage: / || /^       slender / || (usage && /^       /) {
    if (!usage) print ".nf"
    usage = 1
    sub(/^(usage: |       )/, "")
    put(plain($0))
    next
}
usage { print ".fi"; usage = list = 0; paragraph = 1 }
/^  -/ && match($0, /[^ ]  +[^ ]/) {
    paragraph = 0
    print ".TP\n.B " plain(substr($0, 3, RSTART - 2))
    text(substr($0, RSTART + RLENGTH - 1))
    list = 1
    next
}
/^   / { sub(/^ +/, ""); text($0); next }
{ paragraph = paragraph || list; list = 0; sub(/^ +/, ""); text($0) }
END { if (usage) print ".fi" }'

verbs=$("$program" help | sed -n 's/^  slender \([a-z]*\)  .*/\1/p')
date=$(date -u -d "@${SOURCE_DATE_EPOCH:-$(date +%s)}" +%Y-%m-%d)
version=$("$program" --version | sed -n 's/^slender //p')
cat << END
.TH SLENDER 1 $date "slender $version" "User Commands"
.SH NAME
slender \- simulates and designs slender things
.SH SYNOPSIS
.B slender
.I VERB
.RI [ OPTION ].. \~[ FILE ]
.SH DESCRIPTION
END
"$program" help | sed -n '1s/^s/S/p; s/^Each verb/&/p' | awk "$page"
echo ".SH VERBS"
for verb in $verbs; do
    printf '.SS %s\n' "$verb"
    "$program" help | sed -n "s/^  slender $verb  *\(.*\)/\1./p" | awk "$page"
    printf '.PP\n'
    "$program" "$verb" --help | awk "$page"
done
echo ".SH EXIT STATUS"
"$program" help | sed -n '/^Exit codes: /,$p' | tr '\n' ' ' | sed 's/^Exit codes: //; s/; \([0-9]\)/\n\1/g' |
    awk '{ code = $1; sub(/^[0-9]+ +/, ""); sub(/ +$/, ""); gsub(/-/, "\\-"); print ".TP\n.B " code "\n" $0 }'
cat << END
.SH FILES
Scenes are YAML, results VTKHDF (HDF5), journals SQLite.
Examples are in
.IR /usr/share/doc/slender/examples .
.SH ENVIRONMENT
.TP
.B OPENBLAS_CORETYPE
the kernels of OpenBLAS, where it does not know the processor;
.B slender version
names those in use.
.SH SEE ALSO
.B slender schema \-\-manual
has every key of a scene.
END
