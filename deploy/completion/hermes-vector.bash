# Bash completion of hermes-vector. The options are those its own --help lists.

_hermes_vector() {
    local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command="" i
    COMPREPLY=()
    for ((i = 1; i < COMP_CWORD; ++i)); do
        case ${COMP_WORDS[i]} in
        -*) ;;
        *)
            command=${COMP_WORDS[i]}
            break
            ;;
        esac
    done
    if [ -z "$command" ]; then
        mapfile -t COMPREPLY < <(compgen -W "segment vectorize register similarity match relocalize observe map evaluate ring experiment report --help --version" -- "$word")
        return
    fi
    local help choices
    help=$(hermes-vector "$command" --help 2>/dev/null)
    if [[ $previous == --* ]]; then # "--format KIND:{json,csv}": one of these
        choices=$(sed -nE "s/^ +$previous .*\{([^}]*)\}.*/\1/p" <<<"$help")
        [ -n "$choices" ] && mapfile -t COMPREPLY < <(compgen -W "${choices//,/ }" -- "$word") && return
    fi
    case $previous in
    --k | --min-threshold | --max-threshold | --min-points | --sigma | --delta | --k-alpha | --k-xy | --pose | --expected | --scan | \
        --noise | --fov | --outliers | --seed | --every | --laser | --turn | --case | --rays | --max-dx | --max-dy | \
        --max-dalpha | --deviation-xy | --deviation-alpha | --half | --reliability | --ambiguity | --discrepancy | --runs | --max-points | --first | --draw | --seconds) return ;;
    esac
    if [[ $word == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '--[a-z-]+' <<<"$help" | sort -u)" -- "$word")
        return
    fi
    compopt -o filenames 2>/dev/null
    local worlds=""
    [ "$command" = report ] && worlds="pillars quadratic cutsquare oblique"
    if [ "$command" = experiment ]; then
        choices=$(sed -nE "s/^ +NAME .*\{([^}]*)\}.*/\1/p" <<<"$help")
        mapfile -t COMPREPLY < <(compgen -W "${choices//,/ }" -- "$word")
        return
    fi
    mapfile -t COMPREPLY < <(compgen -f -W "$worlds" -- "$word")
}

complete -F _hermes_vector hermes-vector
