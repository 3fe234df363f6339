# The same robot and daemons as those of docs/troubleshooting.md.
. "$(dirname "${BASH_SOURCE[0]}")/troubleshooting.sh"
