#include "daemons/velodynelogger/LidarMessages.h"

#include "protocol/wire/Fields.h"

namespace hermes::velodynelogger {

Fields<LidarGps> fieldsOf(Of<LidarGps>) {
    using G = LidarGps;
    return Fields<G>()
        .add("pps", &G::pps, "State of the pulse a second")
        .add("nmea", &G::nmea, "Text of the last position packet")
        .add("valid", &G::valid, "The receiver vouches for the text")
        .add("locked", &G::locked, "The sensor's clock follows the pulse")
        .add("packets", &G::packets, "Position packets")
        .add("wrong_value", &G::wrongValue, "Of them: with values that cannot be")
        .add("bad_nmea", &G::badNmea, "Of them: with a text that cannot be read")
        .add("utc", &G::utc, "When the last was sent, since the Unix epoch", "s")
        .add("latitude_deg", &G::latitude_deg, "North", "deg")
        .add("longitude_deg", &G::longitude_deg, "East", "deg");
}

Fields<LidarMessage> fieldsOf(Of<LidarMessage>) {
    using L = LidarMessage;
    return Fields<L>()
        .add("source", &L::source, "Where packets come from; what is counted here, is since it was opened")
        .addOrNull("model", &L::model, "Of the sensor; null before its first packet")
        .addOrNull("sensor", &L::sensor, "Whose packets are decoded: address and ports")
        .add("rpm", &L::rpm, "Turns a minute", "1/min")
        .add("packet_rate_hz", &L::packetRate_hz, "Data packets in the last second", "Hz")
        .add("gps", &L::gps, "What the position packets tell")
        .add("packets", &L::packets, "Data packets")
        .add("turns", &L::turns, "Finished")
        .add("lost", &L::lost, "Data packets, by their stamps")
        .add("gaps", &L::gaps, "In the data packets")
        .add("out_of_order", &L::outOfOrder, "Data packets older than one before")
        .add("clock_jumps", &L::clockJumps, "Of the sensor")
        .add("wrong_size", &L::wrongSize, "Packets that are no data packets")
        .add("wrong_flag", &L::wrongFlag, "Packets whose blocks do not begin as they should")
        .add("wrong_value", &L::wrongValue, "Packets with values that cannot be")
        .add("other_model", &L::otherModel, "Packets of a model that decode.model excludes")
        .add("other_sensors", &L::otherSensors, "Packets of sensors that are not decoded")
        .add("position_packets", &L::positionPackets, "That came")
        .add("other_datagrams", &L::otherDatagrams, "Neither data nor position packets")
        .add("kernel_drops", &L::kernelDrops, "Datagrams that the system had no room for")
        .add("decoder_drops", &L::decoderDrops, "Datagrams recorded, but too many at once to decode")
        .add("receive_buffer_bytes", &L::receiveBufferBytes, "Granted by the system", "byte")
        .add("turns_dropped", &L::turnsDropped, "Finished, but published too slowly")
        .add("clouds_dropped", &L::cloudsDropped, "Finished, but published too slowly")
        .add("recording", &L::recording, "As record.status gives it");
}

Fields<CapturedTurn> fieldsOf(Of<CapturedTurn>) {
    return Fields<CapturedTurn>()
        .add("path", &CapturedTurn::path, "Of the file")
        .add("points", &CapturedTurn::points, "Written");
}

} // namespace hermes::velodynelogger
