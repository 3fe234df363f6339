# What the service does after the installation: the supervisor with the settings of the simulator, here in the folder of the page.
mkdir -p etc state
for file in deploy/settings/simulator/*.json; do
    sed "s,/etc/hermes,$PWD/etc,; s,/run/hermes,$PWD/state,; s,/var/lib/hermes,$PWD/state,; s,/usr/share/hermes,$PWD/deploy," "$file" >"etc/${file##*/}"
done
hermes-supervisor --config etc/supervisor.json >supervisor.log 2>&1 &
for _ in $(seq 20); do
    timeout 5 hermesctl call motorcontrol motor.state 2>/dev/null | grep -q '"confirmed": true' && timeout 2 hermesctl watch scanmatcher pose --count 1 >pose.log 2>&1 && break
    sleep 0.2
done
