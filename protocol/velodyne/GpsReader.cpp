#include "protocol/velodyne/GpsReader.h"

#include "protocol/velodyne/StampClock.h"

namespace hermes::velodyne {

PositionFault GpsReader::feed(const std::uint8_t *bytes, std::size_t size) {
    const PositionFault fault = decodePosition(bytes, size, state_.packet);
    ++counts_.packets;
    counts_.wrongSize += fault == PositionFault::Size;
    counts_.wrongValue += fault == PositionFault::Value;
    if (fault == PositionFault::None)
        readText();
    return fault;
}

void GpsReader::readText() {
    state_.valid = false;
    state_.position.reset();
    state_.utc_ns.reset();
    if (state_.packet.nmea.empty())
        return;
    using Result = nmea::SentenceParser::Result;
    Result result = Result::Incomplete;
    parser_.reset();
    for (const char byte : state_.packet.nmea)
        if ((result = parser_.feed(byte)) != Result::Incomplete)
            break;
    if (result == Result::Incomplete)
        result = parser_.feed('\n');
    nmea::Rmc rmc;
    const bool isRmc = result == Result::Done && parser_.sentence().type() == "RMC";
    if (result != Result::Done || (isRmc && nmea::decode(parser_.sentence(), rmc))) {
        ++counts_.badNmea;
        return;
    }
    if (!isRmc) // some sensors of the family pass on GGA too
        return;
    state_.valid = rmc.valid;
    state_.position = rmc.position;
    if (state_.packet.pps != Pps::Locked || !rmc.valid || !rmc.date || !rmc.time)
        return;
    if (const auto stamp = nmea::toStamp(*rmc.date, *rmc.time))
        state_.utc_ns = nearestHour(state_.packet.stamp_us, std::int64_t(*stamp) * 1000000000);
}

} // namespace hermes::velodyne
