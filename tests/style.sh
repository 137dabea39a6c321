#!/bin/sh
# Files of at most 500 lines; files that sources and pages name are there, in the tree or in their own folder.
cd "$1" || exit 2
bad=0
for file in */*.[ch] */*/*.[ch]; do
    lines=$(wc -l < "$file")
    [ "$lines" -le 500 ] || { echo "$file has $lines lines; 500 is the limit"; bad=1; }
done

folders=$(ls -d [a-z]*/ | grep -v '^build' | tr -d / | paste -sd '|')
named=$(grep -oE "(^|[^a-zA-Z0-9_./}\"-])($folders|page)/[a-z0-9_/]+\.(c|h|js|css|html|py|sh|md|yaml)\\b" \
    README.md do ./[a-z]*/*.md ./*/*.[ch] ./*/*/*.[ch] ./report/page/* ./python/*.py ./python/*/*.py | grep -v '^\./build' | sort -u)
for pair in $(echo "$named" | sed 's/^\([^:]*\):[^a-z]*/\1:/'); do
    by=${pair%%:*} name=${pair#*:}
    [ -e "$name" ] || [ -e "${by%/*}/$name" ] || { echo "$by names $name, which is not there"; bad=1; }
done
exit $bad
