#include "gui/vector/LidarCapture.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Options.h"

#include <arpa/inet.h>

namespace hermes {

namespace {

using velodyne::PacketFault;

SensorChoice::Options choiceOf(const SensorOptions &options) {
    SensorChoice::Options choice;
    choice.port = options.port;
    in_addr address{};
    if (!options.sender.empty() && inet_pton(AF_INET, options.sender.c_str(), &address) == 1)
        choice.address = ntohl(address.s_addr);
    return choice;
}

std::string withCount(const SensorChoice::Sensor &sensor) {
    return toText(sensor) + " (" + std::to_string(sensor.packets) + " packets)";
}

/// Lists all but the one that is taken.
std::string listOthers(const SensorChoice &choice) {
    std::string text;
    for (const SensorChoice::Sensor &sensor : choice.sensors()) {
        if (&sensor != choice.taken())
            text += (text.empty() ? "" : ", ") + withCount(sensor);
    }
    return text;
}

} // namespace

void SensorOptions::addTo(CLI::App &sub) {
    sub.add_option("--port", port, "Of a capture: the sensor that sends its data packets to this port")
        ->check(between(1, 65535))
        ->type_name("PORT");
    sub.add_option("--sender", sender, "Of a capture: the sensor that has this address")
        ->check(CLI::ValidIPV4)
        ->type_name("ADDRESS");
}

LidarCapture::LidarCapture(const std::string &path, const SensorOptions &options, velodyne::Model model)
    : path_(path)
    , options_(options)
    , model_(model)
    , file_(path)
    , choice_(choiceOf(options)) {
    if (!reader_.open(file_.path()))
        throw Failure(file_.inWordsOfOriginal(reader_.error()));
}

std::string LidarCapture::read(velodyne::TurnAssembler &assembler,
                               const std::function<void(std::uint64_t)> &progress) {
    Datagram datagram;
    PcapReader::Next next;
    while ((next = reader_.next(datagram)) == PcapReader::Next::Datagram) {
        take(datagram, assembler);
        if (progress)
            progress(reader_.counts().records);
    }
    if (next == PcapReader::Next::Failed)
        throw Failure(file_.inWordsOfOriginal(reader_.error()));
    assembler.finish();
    return notice(assembler.counts());
}

void LidarCapture::take(const Datagram &datagram, velodyne::TurnAssembler &assembler) {
    if (datagram.size == velodyne::positionPacketSize) {
        if (choice_.isFromTaken(datagram) &&
            gps_.feed(datagram.payload, datagram.size) == velodyne::PositionFault::None)
            assembler.follow(gps_.state().utc_ns);
        return;
    }
    const PacketFault fault = velodyne::DataPacket::check(datagram.payload, datagram.size, model_);
    if (fault == PacketFault::None ? choice_.takes(datagram) : isDamaged(datagram, fault))
        assembler.feed(datagram.payload, datagram.size, datagram.stamp_ns);
}

/// The assembler counts what came as data packets should and is none that can be decoded.
bool LidarCapture::isDamaged(const Datagram &datagram, PacketFault fault) const {
    const bool likely = choice_.taken() || fault == PacketFault::Model ||
                        datagram.destinationPort == options_.port.value_or(velodyne::dataPort);
    return likely && choice_.mayTake(datagram);
}

std::string LidarCapture::notice(const velodyne::PacketCounts &counts) const {
    if (const SensorChoice::Sensor *taken = choice_.taken())
        return choice_.sensors().size() == 1 ? std::string()
                                             : path_ + ": read " + withCount(*taken) + ", not " +
                                                   listOthers(choice_) + "; --port and --sender choose";
    if (!choice_.sensors().empty())
        throw Failure(path_ + ": found data packets of " + listOthers(choice_) + " only, expected some" +
                      (options_.port ? " to port " + std::to_string(*options_.port) : "") +
                      (options_.sender.empty() ? "" : " from " + options_.sender));
    throw Failure(
        path_ + ": found " +
        (counts.otherModel > 0 ? "only packets of another sensor or return mode" : "no data packet") +
        ", expected those of an HDL-32E or VLP-16: UDP datagrams of 1206 bytes whose blocks begin with FF "
        "EE");
}

} // namespace hermes
