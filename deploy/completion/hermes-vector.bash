# Bash completion of hermes-vector. Its --help tells the commands, their options, and what follows each.

_hermes_vector_words() {
    mapfile -t COMPREPLY < <(compgen -W "${2//,/ }" -- "$1")
}

_hermes_vector_files() {
    compopt -o filenames 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -f -W "$2" -- "$1")
}

# What follows an option is told by the word after it in the help: "KIND:{one,other}", "FILE", "N"; an option that takes no value
# has none. False where nothing is known of what follows the word before.
_hermes_vector_value() {
    local word=$1 previous=$2 help=$3 kind
    [[ $previous == --* ]] || return 1
    kind=$(sed -nE "s/^  (-h,|--[a-z-]+,)?$previous (.*)/\2/p" <<<"$help")
    case ${kind%% *} in
    "" | Needs: | Excludes:) return 1 ;;
    FILE* | FOLDER*) _hermes_vector_files "$word" ;;
    *:*) [[ $kind =~ ^[^\ ]+:.*\{([^}]*)\} ]] && _hermes_vector_words "$word" "${BASH_REMATCH[1]}" ;;
    esac
    return 0
}

_hermes_vector() {
    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command="" help names i
    COMPREPLY=()
    for ((i = COMP_CWORD - 1; i > 0; --i)); do
        [[ ${COMP_WORDS[i]} != -* ]] && command=${COMP_WORDS[i]}
    done
    help=$(COLUMNS=10000 "$1" ${command:+"$command"} --help 2>/dev/null) # unbroken
    if [[ -z $command ]]; then
        names=$(sed -nE '1,/^Subcommands:/d; s/^  ([a-z-]+) .*/\1/p' <<<"$help")
        _hermes_vector_words "$word" "$names --help --version"
        return
    fi
    case $word:$previous in # Bash cuts "--method=global" at its "="
    =:*) word="" ;;
    *:=) previous=${COMP_WORDS[COMP_CWORD - 2]} ;;
    esac
    _hermes_vector_value "$word" "$previous" "$help" && return
    if [[ $word == -* ]]; then
        _hermes_vector_words "$word" "$(sed -nE 's/^  (-h,)?(--[a-z,-]+).*/\2/p' <<<"$help")"
        return
    fi
    names=$(sed -nE 's/^  NAME [^ ]*\{([^}]*)\}.*/\1/p' <<<"$help")
    case $command in
    experiment) _hermes_vector_words "$word" "$names" ;;
    report) _hermes_vector_files "$word" "pillars quadratic cutsquare oblique" ;;
    *) _hermes_vector_files "$word" ;;
    esac
}

complete -F _hermes_vector hermes-vector
