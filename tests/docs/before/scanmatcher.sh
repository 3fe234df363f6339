# A simulated robot that drives through its room, with lidar and odometry, and the journal of a matcher that was killed on the way.
hermes-simulator --set world=deploy/worlds/pillars.json --set robot.autostart=true --set motors.link="$PWD/motors" >simulator.log 2>&1 &
for _ in $(seq 100); do [ -e motors ] && break; sleep 0.1; done
hermes-motorcontrol --set controllers.1.url="serial://$PWD/motors?baud=115200" \
                    --set controllers.2.url="serial://$PWD/motors?baud=115200" >motorcontrol.log 2>&1 &
hermes-velodynelogger >velodynelogger.log 2>&1 &
hermes-scanmatcher --set map.journal=drive.journal >killed.log 2>&1 &
killed=$!
for _ in $(seq 200); do [ -s drive.journal ] && break; sleep 0.1; done
kill -KILL $killed
wait $killed || true
