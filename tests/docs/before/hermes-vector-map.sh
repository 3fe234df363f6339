# The files that docs/hermes-vector.md makes for the examples of both pages.
sed -n '/^### Files for the examples/,/^## /p' docs/hermes-vector.md | sed -n '/^```sh/,/^```$/p' | sed '/^```/d' >files.sh
[ -s files.sh ] && . ./files.sh
