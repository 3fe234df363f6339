# The GPS receiver of a simulated robot.
hermes-simulator --set world=deploy/worlds/pillars.json --set gps.link="$PWD/gps" >simulator.log 2>&1 &
for _ in $(seq 100); do [ -e gps ] && break; sleep 0.1; done
