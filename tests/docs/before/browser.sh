# The daemons of a simulated robot.
hermes-simulator --set world=deploy/worlds/pillars.json >simulator.log 2>&1 &
hermes-motorcontrol >motorcontrol.log 2>&1 &
for daemon in simulator motorcontrol; do
    for _ in $(seq 100); do hermesctl call $daemon daemon.info >/dev/null 2>&1 && break; sleep 0.1; done
done
