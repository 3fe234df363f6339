# Two loggers, of the lidar and of the GPS receiver of a simulated robot that drives through its room.
hermes-simulator --set world=deploy/worlds/pillars.json --set robot.autostart=true --set gps.link="$PWD/gps" >simulator.log 2>&1 &
for _ in $(seq 100); do [ -e gps ] && break; sleep 0.1; done
hermes-velodynelogger --set record.folder=recordings >velodynelogger.log 2>&1 &
hermes-recorder --set record.folder=recordings >recorder.log 2>&1 &
hermes-seriallogger --set record.folder=recordings \
    --set ports='[{"name": "gps", "url": "serial://'"$PWD"'/gps?baud=9600", "view": "nmea"}]' >seriallogger.log 2>&1 &
for daemon in velodynelogger seriallogger recorder; do
    for _ in $(seq 100); do hermesctl call $daemon daemon.info >/dev/null 2>&1 && break; sleep 0.1; done
done
