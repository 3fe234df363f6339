# The recorder of a simulated robot, whose lidar it records.
hermes-simulator --set world=deploy/worlds/pillars.json >simulator.log 2>&1 &
hermes-velodynelogger --set record.folder=recordings >velodynelogger.log 2>&1 &
hermes-recorder --set record.folder=recordings >recorder.log 2>&1 &
for daemon in velodynelogger recorder; do
    for _ in $(seq 100); do hermesctl call $daemon daemon.info >/dev/null 2>&1 && break; sleep 0.1; done
done
