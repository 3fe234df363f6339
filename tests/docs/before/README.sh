# The daemons of the demo, as it runs.
hermes-simulator --set world=deploy/worlds/pillars.json --set robot.autostart=true >simulator.log 2>&1 &
hermes-velodynelogger >velodynelogger.log 2>&1 &
hermes-scanmatcher --set source.address=127.0.0.1:7420 >scanmatcher.log 2>&1 &
for daemon in simulator velodynelogger scanmatcher; do
    for _ in $(seq 100); do hermesctl call "$daemon" daemon.info >/dev/null 2>&1 && break; sleep 0.1; done
done
