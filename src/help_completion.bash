#!/bin/bash
# help_completion.bash: the part of the bash completion that does not depend on the commands; help.sh
# writes the tables before it. Sourced by bash, without the functions of the package bash-completion.
# shellcheck disable=SC2154 # the tables
# _hnbrdf_files ENDING...: folders, and files that end so in any case; all where none does.
_hnbrdf_files() {
    local name ending all=()
    compopt -o filenames 2> /dev/null
    while IFS= read -r name; do
        all+=("$name")
        [[ ! -d $name ]] || COMPREPLY+=("$name")
        for ending; do
            [[ -d $name || ${name,,} != *"$ending" ]] || COMPREPLY+=("$name")
        done
    done < <(compgen -f -- "$cur")
    [ ${#COMPREPLY[@]} -gt 0 ] || COMPREPLY=("${all[@]}")
}

_hnbrdf_words() {
    mapfile -t COMPREPLY < <(compgen -W "$*" -- "$cur")
}

# _hnbrdf_kind KIND...: what the tables say of a value or a place.
_hnbrdf_kind() {
    local words=() what=$1 ending
    shift
    case $what in
    words)
        while [ $# -gt 0 ] && [ "$1" != files ]; do words+=("$1") && shift; done
        local with_files=${1:-}
        _hnbrdf_words "${words[@]}"
        [ -z "$with_files" ] || { shift && local found=("${COMPREPLY[@]}") && COMPREPLY=() &&
            _hnbrdf_files "$@" && COMPREPLY=("${found[@]}" "${COMPREPLY[@]}"); }
        ;;
    files) _hnbrdf_files "$@" ;;
    data)
        # shellcheck disable=SC2086 # endings are words
        _hnbrdf_files $_hnbrdf_data "$@"
        [[ builtin != "$cur"* ]] || COMPREPLY+=(builtin)
        ;;
    folder)
        compopt -o filenames 2> /dev/null
        mapfile -t COMPREPLY < <(compgen -d -- "$cur")
        ;;
    any) _hnbrdf_files ;;
    esac
}

# = and : are words of their own in COMP_WORDS: --kind = hybrid, builtin : NAME.
_hnbrdf() {
    local cur=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
    local first=2 option="" kind options places place k
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        _hnbrdf_words "$_hnbrdf_commands"
        return
    fi
    if [ "$command" = report ]; then
        if [ "$COMP_CWORD" -eq 2 ]; then
            _hnbrdf_words "$_hnbrdf_reports"
            return
        fi
        command="report ${COMP_WORDS[2]}" first=3
    fi
    [ "$cur" != : ] || { before=: cur="" && COMP_CWORD=$((COMP_CWORD + 1)); }
    if [ "$before" = : ] && [ "${COMP_WORDS[COMP_CWORD - 2]}" = builtin ]; then
        _hnbrdf_words "$_hnbrdf_builtin"
        return
    fi
    if [ "$cur" = = ]; then
        option=$before cur=""
    elif [ "$before" = = ]; then
        option=${COMP_WORDS[COMP_CWORD - 2]}
    elif [[ $before == -?* ]]; then
        option=$before
    fi
    if [ -n "$option" ] && _hnbrdf_value "$command" "$option"; then
        # shellcheck disable=SC2086 # kinds are words
        _hnbrdf_kind $kind
        return
    fi
    _hnbrdf_table "$command"
    if [[ $cur == -* ]]; then
        _hnbrdf_words "$options"
        return
    fi
    # The place that this word is for: those before it that are neither options nor their values.
    for ((k = first, place = 0; k < COMP_CWORD; k++)); do
        case ${COMP_WORDS[k]} in
        -?*)
            if [ "${COMP_WORDS[k + 1]}" = = ]; then
                k=$((k + 2))
            elif _hnbrdf_value "$command" "${COMP_WORDS[k]}"; then
                k=$((k + 1))
            fi
            ;;
        :) k=$((k + 1)) ;;
        *) place=$((place + 1)) ;;
        esac
    done
    IFS=, read -r -a places <<< "$places"
    [ "$place" -lt ${#places[@]} ] || place=$((${#places[@]} - 1))
    # shellcheck disable=SC2086 # kinds are words
    [ "$place" -lt 0 ] || _hnbrdf_kind ${places[place]}
}
complete -F _hnbrdf hnbrdf
