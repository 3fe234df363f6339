# A capture of two seconds of the simulated HDL-32E: drive.pcap.
hermes-simulator --set world=deploy/worlds/pillars.json >simulator.log 2>&1 &
simulator=$!
hermes-velodynelogger --set record.folder="$PWD/captures" >velodynelogger.log 2>&1 &
logger=$!
for _ in $(seq 100); do hermesctl call velodynelogger record.start name=drive >start.log 2>&1 && break; sleep 0.1; done
sleep 2
hermesctl call velodynelogger record.stop >stop.log
kill $simulator $logger
cp captures/drive/velodynelogger-0001.pcap drive.pcap
