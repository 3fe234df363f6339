#!/bin/bash
# Fails on words that are commonly misspelt, in the manual, the comments and the messages of all programs. Words that are right here: spelling_words.txt.
set -u
cd "${HERMES_SOURCE:-$(dirname "$0")/../..}" || exit 1
if ! command -v codespell >/dev/null; then
    echo "codespell is not installed"
    exit 77
fi
if ! printf 'teh recieve\n' | codespell - | grep -q receive; then
    echo "the check itself finds nothing"
    exit 1
fi
files=$(git ls-files 2>/dev/null | grep -E '\.(md|h|cpp|py|sh|txt|json|cmake)$' | grep -vE '^tests/(data/|docs/spelling)')
if [ -z "$files" ]; then
    echo "no working copy of git, whose files would be checked"
    exit 77
fi
xargs codespell --ignore-words=tests/docs/spelling_words.txt <<<"$files"
