#!/usr/bin/env bash
# The packages in a fresh Debian: deploy/test-install, with those that tests/deploy/packages.sh has built.
set -euo pipefail
exec "$HERMES_SOURCE/deploy/test-install"
