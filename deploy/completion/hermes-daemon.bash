# Bash completion for the daemons and hermes-gui; installed under the name of each.

# The dotted paths of a daemon's settings.
_hermes_daemon_paths() {
    "$1" --print-settings 2>/dev/null | python3 -c '
import json, sys
def paths(value, prefix=""):
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from paths(inner, f"{prefix}.{name}" if prefix else name)
    else:
        yield prefix
print("\n".join(f"{path}=" for path in paths(json.load(sys.stdin))))' 2>/dev/null
}

_hermes_daemon() {
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    case $1:$previous in
    *:--config | *:--layout) mapfile -t COMPREPLY < <(compgen -f -- "$current") ;;
    *:--listen | *:--connect) ;;
    *:--set) compopt -o nospace && mapfile -t COMPREPLY < <(compgen -W "$(_hermes_daemon_paths "$1")" -- "$current") ;;
    *hermes-gui:*) mapfile -t COMPREPLY < <(compgen -W "--connect --layout --whole-map --help --help-all --version" -- "$current") ;;
    *) mapfile -t COMPREPLY < <(compgen -W "--config --set --listen --print-settings --check --help --version" -- "$current") ;;
    esac
}
complete -F _hermes_daemon hermes-{supervisor,motorcontrol,velodynelogger,seriallogger,softwaretrigger,scanmatcher,recorder,ros2,scanner,simulator,web,gui}
