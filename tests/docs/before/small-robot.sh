# A simulated robot with an Arduino and an RPLIDAR, whose lines are at base and laser, and a supervisor that has no settings yet.
hermes-simulator --set world=deploy/worlds/pillars.json --set motors.kind=arduino --set motors.link="$PWD/base" \
                 --set frame.layout=two_wheels --set frame.counts_per_turn=3600 --set motors.full_speed=12000 \
                 --set scanner.model=rplidar-a1 --set scanner.link="$PWD/laser" \
                 --set lidar.port=0 >simulator.log 2>&1 &
for _ in $(seq 100); do [ -e base ] && [ -e laser ] && break; sleep 0.1; done
mkdir etc
echo '{}' >etc/supervisor.json
hermes-supervisor --config etc/supervisor.json --set setup.folder="$PWD/etc" \
                  --set setup.ports="[\"$PWD/base\", \"$PWD/laser\"]" >supervisor.log 2>&1 &
for _ in $(seq 100); do hermesctl call supervisor daemon.info >/dev/null 2>&1 && break; sleep 0.1; done
