#!/usr/bin/env bash
# The configuration of deploy/board is as the programs want it that read it: each checks its own files, then the same files with one
# line spoilt, which it has to refuse. Skips when one of them is not installed, after all others have been asked.
set -uo pipefail
board=$HERMES_SOURCE/deploy/board
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
chmod 755 "$work" # networkd reads as a user of its own
PATH=$PATH:/usr/sbin:/sbin
absent=() failed=0
libexec=/lib/systemd

# Each check_NAME TREE checks the files of its program below TREE, a copy of deploy/board/etc; what it prints tells what is wrong.

check_dnsmasq() { dnsmasq --test -C "$1/dnsmasq.d/hermes.conf" 2>&1; }
check_chronyd() { chronyd -p -f "$1/chrony/conf.d/hermes.conf" 2>&1; }
check_sysctl() { sysctl --dry-run -p "$1/sysctl.d/60-hermes.conf" 2>&1; }
check_nft() { unshare -rn nft -c -f "$1/nftables.conf" 2>&1; }
check_sh() { sh -n "$1/default/gpsd" 2>&1 && sh -n "$1/overlayroot.local.conf" 2>&1; }

# It has no mode for this: it reads its file, then looks for its interface, and there is none of this name.
check_hostapd() {
    sed 's/^interface=.*/interface=absent0/' "$1/hostapd/wifi.conf" >"$1/wifi.conf"
    timeout 30 hostapd "$1/wifi.conf" >"$1/log" 2>&1
    cat "$1/log"
    grep -q "interface state" "$1/log" && ! grep -q "errors found" "$1/log"
}

# The disks are not here, so that only its parser counts; what systemd makes of the lines must be whole units that hold up no start.
check_findmnt() {
    local units=$1/mounts mount
    findmnt --verify --tab-file "$1/fstab.hermes" 2>&1 | tee "$1/log"
    grep -q "^0 parse errors" "$1/log" || return 1
    mkdir "$units"
    SYSTEMD_FSTAB=$1/fstab.hermes $libexec/system-generators/systemd-fstab-generator "$units" "$units" "$units" 2>&1 || return 1
    for mount in var-lib-hermes etc-hermes data; do
        [ -e "$units/local-fs.target.wants/$mount.mount" ] || { echo "$mount.mount: expected as wanted by local-fs.target"; return 1; }
    done
    is_silent systemd-analyze verify --man=no --recursive-errors=no "$units"/*.mount
}

is_silent() { # a program that only warns
    local said
    said=$("$@" 2>&1) && [ -z "$said" ] && return 0
    echo "$said"
    return 1
}

# The programs of ours that the units start need not be installed.
check_units() {
    cp "$HERMES_SOURCE"/deploy/systemd/hermes-supervisor.service "$1/systemd/system"
    sed -Ei 's,^(ExecStart=)/usr/(bin|share)/hermes\S*,\1/bin/true,; s,gpspipe,true,' "$1"/systemd/system/*.service
    SYSTEMD_UNIT_PATH="$1/systemd/system:" is_silent systemd-analyze verify --man=no --recursive-errors=no \
        "$1"/systemd/system/*.service "$1"/systemd/system/*.timer
}

# Nothing reads system.conf but the first process of a system: whether it knows the keys stands in its program.
check_manager() {
    local key value
    while IFS='=' read -r key value; do
        grep -qaxzF -- "$key" $libexec/systemd || { echo "$key: $libexec/systemd does not know it"; return 1; }
        systemd-analyze timespan "$value" >/dev/null || return 1
    done < <(grep -v '^[#[]' "$1/systemd/system.conf.d/hermes.conf")
}

# These two have no mode for checking either. Each is started where it sees our files and nothing of this machine, until it says
# that it has read them; what it says of the files is what is wrong.
started_alone() { # TREE, PROGRAM, WHAT IT SAYS THEN
    local log=$1/log
    : >"$log"
    # shellcheck disable=SC2016
    SYSTEMD_LOG_TARGET=console SYSTEMD_LOG_LEVEL=debug SYSTEMD_LOG_COLOR=0 timeout 30 unshare -mnp --fork --kill-child bash -c '
        mount --bind "$1/systemd" /etc/systemd && mount -t tmpfs tmpfs /run && mkdir -p /run/systemd/journal /run/log &&
        exec "$2"' sh "$1" "$2" >"$log" 2>&1 &
    local program=$!
    for ((i = 0; i < 300; ++i)); do
        grep -q "$3" "$log" && break
        kill -0 $program 2>/dev/null || break
        sleep 0.1
    done
    kill $program 2>/dev/null
    wait $program
    grep -q "$3" "$log" || { cat "$log"; echo "$2: expected it to say \"$3\""; return 1; }
    ! grep "^/etc/systemd/.*:[0-9]*: \|configured in \"/etc/systemd/" "$log"
}
check_networkd() { started_alone "$1" $libexec/systemd-networkd "Enumeration completed"; }
check_journald() { started_alone "$1" $libexec/systemd-journald "Journal"; }

check_udevd() {
    # shellcheck disable=SC2016
    unshare -rm bash -c 'mount -t tmpfs tmpfs /run && mount --bind "$1" /etc/systemd/network &&
        udevadm test --action=add /sys/class/mem/null' sh "$1/systemd/network" >"$1/log" 2>&1 || { cat "$1/log"; return 1; }
    ! grep "^/etc/systemd/network/.*:[0-9]*: " "$1/log"
}

check_settings() {
    local file name
    for file in "$1"/hermes/*.json; do
        name=$(basename "$file" .json)
        "$HERMES_BIN/hermes-$name" --config "$file" --check 2>&1 || return 1
    done
}

copy_of_board() { # NAME
    cp -r "$board/etc" "$work/$1"
    chmod -R a+rX "$work/$1"
    echo "$work/$1"
}

needs() { # PROGRAM...: whether all are here
    local program
    for program; do
        command -v "$program" >/dev/null || { absent+=("$program"); return 1; }
    done
}

check() { # NAME FILE EXPRESSION: the files are fine, and they are not when sed has changed FILE by the EXPRESSION
    local name=$1 file=$2 expression=$3 tree
    tree=$(copy_of_board "$name-good")
    "check_$name" "$tree" >"$work/said" || { echo "FAILED $name:"; cat "$work/said"; failed=1; return; }
    tree=$(copy_of_board "$name-bad")
    sed -i "$expression" "$tree/$file"
    cmp -s "$tree/$file" "$board/etc/$file" && { echo "FAILED $name: '$expression' does not change $file"; failed=1; return; }
    "check_$name" "$tree" >"$work/said" && { echo "FAILED $name: takes $file with '$expression'"; failed=1; return; }
    echo "passed $name"
}

check sh overlayroot.local.conf 's/"$//'
check settings hermes/seriallogger.json 's/"view"/"veiw"/'
needs dnsmasq && check dnsmasq dnsmasq.d/hermes.conf 's/^dhcp-authoritative/dhcp-autoritative/'
needs hostapd && check hostapd hostapd/wifi.conf 's/^channel/chanel/'
needs chronyd && check chronyd chrony/conf.d/hermes.conf 's/refid PPS/refit PPS/'
needs sysctl && check sysctl sysctl.d/60-hermes.conf 's/rmem_max/rmem_maxx/'
needs systemd-analyze findmnt && check findmnt fstab.hermes 's/^\(LABEL=hermes-data *\).*/\1/'
needs systemd-analyze && check units systemd/system/hermes-make-room.timer 's/^OnBootSec/OnBotSec/'
needs systemd-analyze && check manager systemd/system.conf.d/hermes.conf 's/RuntimeWatchdogSec/RuntimeWatchdogSecs/'
if ! unshare -mn true 2>/dev/null; then
    absent+=("the right to mount, for systemd-networkd and systemd-journald")
else
    needs $libexec/systemd-networkd && check networkd systemd/network/30-lidar.network 's,192.168.1.100/24,192.168.1.300/24,'
    needs $libexec/systemd-journald && check journald systemd/journald.conf.d/hermes.conf 's/volatile/volatil/'
fi
if ! unshare -rm true 2>/dev/null; then
    absent+=("a namespace of users, for udev and nft")
else
    if needs nft; then
        if unshare -rn nft list ruleset >/dev/null 2>&1; then
            check nft nftables.conf 's/iifname/iifnam/'
        else
            absent+=("nf_tables in the kernel")
        fi
    fi
    needs udevadm && check udevd systemd/network/10-wifi.link 's/^Type=/Tipe=/'
fi

[ $failed -eq 0 ] || exit 1
[ ${#absent[@]} -eq 0 ] || { printf 'skipped, absent: %s\n' "${absent[@]}"; exit 77; }
