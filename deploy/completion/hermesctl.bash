# Bash completion for hermesctl, which tells itself what may follow; installed as share/bash-completion/completions/hermesctl,
# or for one shell: source <(hermesctl completion bash)

_hermesctl() {
    local line=${COMP_LINE:0:COMP_POINT} candidate cut
    # Bash replaces only what follows the last "=" or ":" of a word, which it gives as $2.
    cut=${line##*[[:space:]]}
    cut=${cut%"$2"}
    COMPREPLY=()
    while IFS= read -r candidate; do
        candidate=${candidate%%$'\t'*}
        if [ "$candidate" = :files ]; then
            compopt -o filenames +o nospace 2>/dev/null
            mapfile -t COMPREPLY < <(compgen -f -- "$2")
            return
        fi
        [[ $candidate == *= ]] || candidate+=" "
        COMPREPLY+=("${candidate#"$cut"}")
    done < <("$1" complete "$line" 2>/dev/null)
}
complete -o nospace -F _hermesctl hermesctl
