# Bash completion for hermesctl; installed as share/bash-completion/completions/hermesctl.

# The names below "commands:" or "topics:" in what a daemon tells about itself; nothing when it does not run.
_hermesctl_names() {
    hermesctl --timeout 1 discover "$2" 2>/dev/null |
        awk -v section="$1:" '/^[a-z]/ { inside = $0 == section } inside && /^  [^ ]/ { print $1 }'
}

_hermesctl() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} words=() word candidates=
    for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
        [[ $word == -* ]] || words+=("$word")
    done
    case $previous in
    --host | --timeout | --rate | --count | --daemons | --speed) return ;;
    esac
    if [[ $current == -* ]]; then
        candidates="--host --timeout --rate --count --daemons --speed --loop --csv --json --follow --help --version"
    elif [ ${#words[@]} -eq 0 ]; then
        candidates="list record replay discover call get set watch log doc"
    elif [ ${#words[@]} -eq 1 ] && [ "${words[0]}" = record ]; then
        candidates="start stop mark status list"
    elif [ ${#words[@]} -eq 1 ] && [ "${words[0]}" = replay ]; then
        candidates=$(hermesctl --timeout 1 record list 2>/dev/null | awk 'NR > 1 { print $1 }')
    elif [ ${#words[@]} -eq 1 ] && [ "${words[0]}" != list ]; then
        candidates="supervisor motorcontrol velodynelogger seriallogger softwaretrigger scanmatcher simulator"
    elif [ ${#words[@]} -eq 2 ] && [ "${words[0]}" = call ]; then
        candidates=$(_hermesctl_names commands "${words[1]}")
    elif [ ${#words[@]} -eq 2 ] && [ "${words[0]}" = watch ]; then
        candidates=$(_hermesctl_names topics "${words[1]}")
    fi
    mapfile -t COMPREPLY < <(compgen -W "$candidates" -- "$current")
}
complete -F _hermesctl hermesctl
