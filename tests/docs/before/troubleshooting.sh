# A simulated robot with its daemons, and a supervisor that starts the trigger by a settings file of the page, wrong.json.
hermes-simulator --set world=deploy/worlds/pillars.json --set motors.link="$PWD/motors" >simulator.log 2>&1 &
for _ in $(seq 100); do [ -e motors ] && break; sleep 0.1; done
hermes-motorcontrol --set controllers.1.url="serial://$PWD/motors?baud=115200" \
                    --set controllers.2.url="serial://$PWD/motors?baud=115200" >motorcontrol.log 2>&1 &
hermes-velodynelogger --set record.folder=recordings >velodynelogger.log 2>&1 &
hermes-recorder --set record.folder=recordings >recorder.log 2>&1 &
hermes-scanmatcher --set odometry.address=127.0.0.1:7410 >scanmatcher.log 2>&1 &
hermes-supervisor --set processes='[{"name": "softwaretrigger", "arguments": ["--config", "wrong.json"]}]' >supervisor.log 2>&1 &
for _ in $(seq 40); do  # until the controllers are set up and scans are matched
    timeout 5 hermesctl call motorcontrol motor.state 2>/dev/null | grep -q '^    "ready": true' &&
        timeout 2 hermesctl watch scanmatcher pose --count 1 >pose.log 2>&1 && break
    sleep 0.2
done
