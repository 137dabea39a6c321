#!/bin/sh
# Files of at most 500 lines.
cd "$1" || exit 2
bad=0
for file in */*.[ch] */*/*.[ch]; do
    lines=$(wc -l < "$file")
    [ "$lines" -le 500 ] || { echo "$file has $lines lines; 500 is the limit"; bad=1; }
done
exit $bad
