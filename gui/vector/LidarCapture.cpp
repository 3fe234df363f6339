#include "gui/vector/LidarCapture.h"

#include "gui/vector/Failure.h"
#include "gui/vector/Options.h"
#include "gui/vector/RecordedSession.h"
#include "vectorlib/io/TextInput.h"

namespace hermes::vector {

namespace {

LidarStream::Options streamOf(const SensorOptions &options, velodyne::Model model,
                              velodyne::ClockChoice clock) {
    LidarStream::Options stream;
    stream.model = model;
    stream.clock = clock;
    stream.sensor.port = options.port;
    stream.sensor.address = addressFrom(options.sender); // none of an empty one
    return stream;
}

std::string withCount(const SensorChoice::Sensor &sensor) {
    return toText(sensor) + " (" + std::to_string(sensor.packets) + " packets)";
}

/// Lists those that were taken, or all others. One that was started anew may send from another port.
std::string listSensors(const SensorChoice &choice, bool wereTaken) {
    std::string text;
    for (const SensorChoice::Sensor &sensor : choice.sensors()) {
        if (sensor.wasTaken == wereTaken)
            text += (text.empty() ? "" : ", ") + withCount(sensor);
    }
    return text;
}

} // namespace

void SensorOptions::addTo(CLI::App &sub) {
    addOption(sub, "--port PORT", port, wholeNumber(1, 65535),
              "Of a capture: the sensor that sends its data packets to this port");
    addOption(sub, "--sender ADDRESS", sender,
              CLI::Validator(
                  [](const std::string &text) {
                      return addressFrom(text)
                                 ? std::string()
                                 : "found " + vectorlib::quoted(text) +
                                       ", expected an IPv4 address: four decimal numbers, dots between";
                  },
                  "", "address"),
              "Of a capture: the sensor that has this address");
}

LidarCapture::LidarCapture(Input &input, const SensorOptions &options, velodyne::Model model,
                           velodyne::ClockChoice clock)
    : name_(input.name())
    , options_(options)
    , stream_(streamOf(options, model, clock)) {
    if (const Outcome<void> opened = reader_.open(input.stream(), name_); !opened)
        throw Failure(opened.error());
}

std::string LidarCapture::read(velodyne::TurnAssembler &assembler) {
    const std::vector<std::string> parts = partsFrom(name_);
    feed(reader_, assembler);
    for (std::size_t i = 1; i < parts.size(); ++i) {
        Input input(parts[i]);
        PcapReader reader;
        if (const Outcome<void> opened = reader.open(input.stream(), input.name()); !opened)
            throw Failure(opened.error());
        feed(reader, assembler);
    }
    assembler.finish();
    const std::string leftOut = counts_.leftOut();
    std::string text;
    for (const std::string &more :
         {parts.size() > 1 ? name_ + ": read on to " + parts.back() : std::string(),
          notice(assembler.counts()), leftOut.empty() ? leftOut : name_ + ": " + leftOut})
        text += (text.empty() || more.empty() ? "" : "; ") + more;
    return text;
}

void LidarCapture::feed(PcapReader &reader, velodyne::TurnAssembler &assembler) {
    Datagram datagram;
    PcapReader::Next next;
    while ((next = reader.next(datagram)) == PcapReader::Next::Datagram)
        stream_.take(datagram, {&assembler});
    if (next == PcapReader::Next::Failed)
        throw Failure(reader.error());
    counts_ += reader.counts();
}

std::string LidarCapture::notice(const velodyne::PacketCounts &counts) const {
    const SensorChoice &choice = stream_.sensors();
    const std::string others = listSensors(choice, false);
    if (choice.taken())
        return others.empty() ? others
                              : name_ + ": read " + listSensors(choice, true) + ", not " + others +
                                    "; --port and --sender choose";
    if (!choice.sensors().empty())
        throw Failure(name_ + ": found data packets of " + others + " only, expected some" +
                      (options_.port ? " to port " + std::to_string(*options_.port) : "") +
                      (options_.sender.empty() ? "" : " from " + options_.sender));
    const std::string leftOut = counts_.leftOut(true);
    throw Failure(
        name_ + ": found " +
        (counts.otherModel > 0 ? "only packets of another sensor or return mode" : "no data packet") +
        ", expected those of an " + velodyne::sensorNames() +
        ": UDP datagrams of 1206 bytes whose blocks begin with FF EE" +
        (leftOut.empty() ? "" : "; " + leftOut));
}

} // namespace hermes::vector
