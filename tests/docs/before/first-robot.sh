# The service after the installation, with the simulated robot at its end: settings in etc, the wires of the controllers in state.
mkdir -p etc state
for file in deploy/settings/simulator/*.json; do
    sed "s,/etc/hermes,$PWD/etc,; s,/run/hermes,$PWD/state,; s,/var/lib/hermes,$PWD/state,; s,/usr/share/hermes,$PWD/deploy," "$file" >"etc/${file##*/}"
done
hermes-supervisor --config etc/supervisor.json --set setup.folder="$PWD/etc" --set setup.samples="$PWD/deploy/settings" \
                  --set setup.ports="[\"$PWD/state/motors\"]" >supervisor.log 2>&1 &
for _ in $(seq 40); do  # until the controllers are set up and scans are matched
    timeout 5 hermesctl call motorcontrol motor.state 2>/dev/null | grep -q '^    "ready": true' &&
        timeout 2 hermesctl watch scanmatcher pose --count 1 >pose.log 2>&1 && break
    sleep 0.2
done
