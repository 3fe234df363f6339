# A simulated robot with its daemons, a supervisor that starts none of them, and a motor control without motors that speaks CBOR.
hermes-simulator --set world=deploy/worlds/pillars.json --set motors.link="$PWD/motors" >simulator.log 2>&1 &
for _ in $(seq 100); do [ -e motors ] && break; sleep 0.1; done
hermes-motorcontrol --set controllers.1.url="serial://$PWD/motors?baud=115200" \
                    --set controllers.2.url="serial://$PWD/motors?baud=115200" >motorcontrol.log 2>&1 &
hermes-velodynelogger --set record.folder=recordings >velodynelogger.log 2>&1 &
hermes-recorder --set record.folder=recordings >recorder.log 2>&1 &
hermes-scanmatcher --set source.address=127.0.0.1:7420 --set odometry.address=127.0.0.1:7410 >scanmatcher.log 2>&1 &
hermes-supervisor >supervisor.log 2>&1 &
hermes-motorcontrol --set listen='["tcp://127.0.0.1:7421?protocol=cbor"]' >cbor.log 2>&1 &
for daemon in simulator motorcontrol velodynelogger scanmatcher recorder supervisor '127.0.0.1:7421?protocol=cbor'; do
    for _ in $(seq 100); do hermesctl call "$daemon" daemon.info >/dev/null 2>&1 && break; sleep 0.1; done
done
