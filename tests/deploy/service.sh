#!/usr/bin/env bash
# The unit of the service as systemd sees it: nothing wrong, and little that it could do beyond its work. The settings of whole robots
# are such as the daemons take.
set -euo pipefail
command -v systemd-analyze >/dev/null || { echo "skipped: needs systemd-analyze (package systemd)"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed "s,^ExecStart=/usr/bin,ExecStart=$HERMES_BIN," "$HERMES_SOURCE/deploy/systemd/hermes-supervisor.service" >"$work/hermes-supervisor.service"
cd "$work"

said=$(SYSTEMD_UNIT_PATH="$work:" systemd-analyze verify --man=no --recursive-errors=no ./hermes-supervisor.service 2>&1) && [ -z "$said" ] ||
    { echo "systemd-analyze verify: $said"; exit 1; }
systemd-analyze security --no-pager --offline=true --threshold=30 ./hermes-supervisor.service >security ||
    { cat security && echo "expected an exposure of at most 3.0"; exit 1; }
tail -1 security

# The drivers of USB serial lines are there when the devices are let in, and a kernel without them holds up nothing.
for module in cdc_acm usbserial; do
    for key in Wants After; do
        grep -q "^$key=.*\bmodprobe@$module\.service\b" hermes-supervisor.service || { echo "$key=: expected modprobe@$module.service"; exit 1; }
    done
done
grep -q "^ExecStart=-" /lib/systemd/system/modprobe@.service || { echo "modprobe@.service: expected to ignore that there is no module"; exit 1; }

# Maps and recordings are read by the group alone: what the package says of their folder systemd says, too.
mode=$(sed -n 's,.*install -d .* -m \(0[0-7]*\) .*/var/lib/hermes.*,\1,p' "$HERMES_SOURCE/deploy/debian/hermes-daemons.postinst")
[ "$mode" = 0750 ] && grep -qx "StateDirectoryMode=$mode" hermes-supervisor.service ||
    { echo "/var/lib/hermes: expected mode 0750 of package ($mode) and unit ($(grep ^StateDirectoryMode hermes-supervisor.service))"; exit 1; }

count=0
for file in "$HERMES_SOURCE"/deploy/settings/*/*.json; do
    "$HERMES_BIN/hermes-$(basename "$file" .json)" --check --config "$file" >/dev/null
    count=$((count + 1))
done
echo "$count settings files are right"
[ "$count" -ge 6 ]
