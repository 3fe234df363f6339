# A simulated robot that drives through its room and sends packets.
hermes-simulator --set world=deploy/worlds/pillars.json --set robot.autostart=true >simulator.log 2>&1 &
