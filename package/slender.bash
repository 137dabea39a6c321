# Completion for bash. Verbs, options and what they may be are asked of the program: nothing here knows their names.
# shellcheck shell=bash

# Of the lines that come in, those that begin with `value`; but for what a shell would take for more than a word.
_slender_offer() {
    local line
    while read -r line; do
        [[ $line != "$value"* || $line == *[^][:alnum:]_./=[-]* ]] || COMPREPLY+=("$line")
    done
}

# Keys up to the next dot or =, then on from there.
_slender_keys() {
    _slender_offer < <("$program" schema --keys | awk -v typed="$value" 'index($0, typed) == 1 {
        rest = substr($0, length(typed) + 1)
        print typed (match(rest, /[.=]./) ? substr(rest, 1, RSTART) : rest)
    }' | sort -u)
    [[ "${COMPREPLY[*]} " != *[.=]" "* ]] || compopt -o nospace 2> /dev/null
}

# Paths in the result that is named on the line, as the lines of `slender info` have them.
_slender_info() { # sed's words for a line
    local word
    for word in "${line[@]}"; do
        [[ $word != *.vtkhdf || ! -r $word ]] || _slender_offer < <("$program" info "$word" 2> /dev/null | sed -n "$1" | sort -u)
    done
}

_slender_files() { # ending ..
    local ending found
    compopt -o filenames 2> /dev/null
    mapfile -t found < <(for ending; do compgen -f -X "!*$ending" -- "$value"; done; compgen -d -- "$value")
    COMPREPLY+=("${found[@]}")
}

# Of a row's words: endings of files, what is to be had elsewhere, and words that may be given.
_slender_values() { # word ..
    local word endings=()
    for word; do
        case $word in
        KEY) _slender_keys ;;
        DATASET) _slender_info 's/^  \(slender\/\)\?\([^ ]*\/[^ ]*\) .*/\2/p' ;;
        FIELD) _slender_info 's/^  VTKHDF\/\(Cell\|Point\)Data\/\([^ ]*\) .*/\2/p' ;;
        CASE) _slender_info 's/^  slender\/cases\/\([^/]*\)\/.*/\1/p' ;;
        SCENE*) endings+=(.yaml .yml) ;;
        RESULT*) endings+=(.vtkhdf) ;;
        .* | NAME.*) endings+=(".${word#*.}") ;;
        [[:upper:]]* | '|') ;; # any file
        *) _slender_offer <<< "$word" ;;
        esac
    done
    [[ ${#endings[@]} -eq 0 ]] || _slender_files "${endings[@]}"
}

_slender() {
    local program=$1 word line=() value before names="" argument="" list="" name letter kind words
    COMPREPLY=()
    for word in "${COMP_WORDS[@]:1:COMP_CWORD}"; do # bash takes job=design apart
        if [[ ${#line[@]} -gt 0 && ($word == = || ${line[-1]} == *=) ]]; then line[-1]+=$word; else line+=("$word"); fi
    done
    value=${line[-1]} before=""
    if [[ ${#line[@]} -eq 1 ]]; then
        _slender_offer < <("$program" help 2> /dev/null | sed -n 's/^  slender \([a-z]*\) .*/\1/p')
        return
    fi
    [[ ${#line[@]} -le 2 ]] || before=${line[-2]}
    [[ $value != --*=* ]] || { before=${value%%=*} value=${value#*=}; }
    while read -r name letter kind words; do
        case $name,$kind in
        argument,*) argument=$words ;;
        *) names+=$name$'\n' ;;
        esac
        [[ $kind != value || ($before != "$name" && $before != "$letter") ]] || list=${words:-any}
    done < <("$program" "${line[0]}" --options 2> /dev/null)
    case ${list:+option},$value in
    option,*) list=${list/#any/} ;;
    ,-*) _slender_offer <<< "$names--help"; list="" ;;
    *) list=$argument ;;
    esac
    set -f
    # shellcheck disable=SC2086
    _slender_values $list
    set +f
    word=${value%"${value##*=}"} # which is not in the word that bash completes
    COMPREPLY=("${COMPREPLY[@]#"$word"}")
}
complete -o default -F _slender slender
