#include "common/capture/LidarStream.h"

#include <cstdlib>
#include <sstream>

namespace hermes {

namespace {

/// Noise that looks like packets of ever more sensors must not fill the memory.
constexpr std::size_t maxSensors = 16;
constexpr std::int64_t anew_ns = 1000000000; ///< a sensor that begins anew has been silent for longer

bool isOf(const SensorChoice::Sensor &sensor, const Datagram &datagram) {
    return sensor.address == datagram.source && sensor.from == datagram.sourcePort &&
           sensor.port == datagram.destinationPort;
}

} // namespace

bool SensorChoice::takes(const Datagram &packet) {
    const std::size_t found = find(packet);
    ++sensors_[found].packets;
    if (!isWanted(packet))
        return false;
    if (taken_ && taken_ != found) {
        if (!lastTaken_ns_)
            lastTaken_ns_ = packet.stamp_ns;
        const bool mayBeginAnew =
            sensors_[*taken_].address == packet.source && sensors_[*taken_].port == packet.destinationPort;
        const auto timeout_ns = options_.timeout_ns || !mayBeginAnew ? options_.timeout_ns : anew_ns;
        if (!timeout_ns || std::abs(packet.stamp_ns - *lastTaken_ns_) <= *timeout_ns)
            return false;
    }
    taken_ = found;
    sensors_[found].wasTaken = true;
    lastTaken_ns_ = packet.stamp_ns;
    return true;
}

bool SensorChoice::isFromTaken(const Datagram &datagram) const {
    const Sensor *const sensor = taken();
    return datagram.source == (sensor ? sensor->address : options_.address.value_or(datagram.source));
}

bool SensorChoice::mayTake(const Datagram &datagram) const {
    return isWanted(datagram) && (!taken_ || isOf(sensors_[*taken_], datagram));
}

std::size_t SensorChoice::find(const Datagram &packet) {
    for (std::size_t i = 0; i < sensors_.size(); ++i) {
        if (isOf(sensors_[i], packet))
            return i;
    }
    if (sensors_.size() < maxSensors)
        sensors_.emplace_back();
    const std::size_t last = sensors_.size() - 1;
    const std::size_t place = taken_ == last ? last - 1 : last;
    sensors_[place] = {packet.source, packet.sourcePort, packet.destinationPort};
    return place;
}

std::optional<std::uint32_t> addressFrom(const std::string &text) {
    std::istringstream in(text);
    std::uint32_t address = 0;
    int parts = 0;
    for (std::string part; std::getline(in, part, '.'); ++parts) {
        const bool isDecimal = !part.empty() && part.size() <= 3 &&
                               part.find_first_not_of("0123456789") == std::string::npos &&
                               (part == "0" || part[0] != '0');
        const unsigned long number = isDecimal ? std::stoul(part) : 256;
        if (number > 255)
            return std::nullopt;
        address = address << 8 | std::uint32_t(number);
    }
    return parts == 4 && text.back() != '.' ? std::optional(address) : std::nullopt;
}

std::string addressText(std::uint32_t address) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
        text += std::to_string(address >> shift & 0xFF) + (shift > 0 ? "." : "");
    return text;
}

std::string toText(const SensorChoice::Sensor &sensor) {
    return addressText(sensor.address) + ':' + std::to_string(sensor.from) + " to port " +
           std::to_string(sensor.port);
}

using scan::HostClock;
using velodyne::ClockChoice;
using velodyne::PacketFault;
using velodyne::TurnAssembler;

void LidarStream::take(const Datagram &datagram, std::initializer_list<TurnAssembler *> assemblers) {
    if (datagram.size == velodyne::positionPacketSize) {
        if (!choice_.isFromTaken(datagram) ||
            gps_.feed(datagram.payload, datagram.size) != velodyne::PositionFault::None)
            return;
        const bool usedHost = usesHost();
        isSet_ = isSet_ || gps_.state().utc_ns;
        return follow(assemblers, usedHost);
    }
    const PacketFault fault = velodyne::DataPacket::check(datagram.payload, datagram.size, options_.model);
    if (fault == PacketFault::None && !choice_.takes(datagram)) {
        ++otherSensors_;
        return;
    }
    if (fault != PacketFault::None && !isDamaged(datagram, fault)) {
        ++other_;
        return;
    }
    const bool usedHost = usesHost();
    const auto host = fault == PacketFault::None ? hostTime(datagram) : std::nullopt;
    if (usedHost != usesHost())
        follow(assemblers, usedHost);
    for (TurnAssembler *assembler : assemblers)
        if (assembler)
            assembler->feed(datagram.payload, datagram.size, datagram.stamp_ns, host);
}

/// What the GPS tells, or that it tells nothing. Another clock begins another time.
void LidarStream::follow(std::initializer_list<TurnAssembler *> assemblers, bool usedHost) {
    for (TurnAssembler *assembler : assemblers) {
        if (assembler && usedHost != usesHost())
            assembler->jump();
        if (assembler)
            assembler->follow(gps_.state().utc_ns);
    }
}

bool LidarStream::usesHost() const {
    return options_.clock == ClockChoice::Host || (options_.clock == ClockChoice::Auto && !isSet_);
}

/// Of a data packet, when the receiver's clock counts. Of one that was started anew all that a
/// GPS has told it is gone.
std::optional<HostClock::Time> LidarStream::hostTime(const Datagram &datagram) {
    const velodyne::DataPacket packet(datagram.payload);
    const bool isNamed = packet.model() != velodyne::Model::Blank;
    const velodyne::SensorModel *const model =
        velodyne::findSensorModel(isNamed ? packet.model() : options_.model);
    const std::uint64_t restarts = host_.restarts();
    const HostClock::Time time = host_.take(packet.stamp_us() * std::int64_t(1000), datagram.stamp_ns,
                                            packet.groups() * model->blockPeriod_ns());
    if (host_.restarts() != restarts) {
        isSet_ = false;
        gps_.forget();
    }
    return usesHost() ? std::optional(time) : std::nullopt;
}

bool LidarStream::isDamaged(const Datagram &datagram, PacketFault fault) const {
    if (fault == PacketFault::Model)
        return choice_.isWanted(datagram);
    const bool likely =
        choice_.taken() || datagram.destinationPort == options_.sensor.port.value_or(options_.dataPort);
    return likely && choice_.mayTake(datagram);
}

} // namespace hermes
