# A scan matcher that gets scans of the simulated robot.
hermes-simulator --set world=deploy/worlds/pillars.json >simulator.log 2>&1 &
hermes-velodynelogger >velodynelogger.log 2>&1 &
hermes-scanmatcher >scanmatcher.log 2>&1 &
for _ in $(seq 20); do timeout 2 hermesctl watch scanmatcher pose --count 1 >pose.log 2>&1 && break; sleep 0.2; done
