#include "tests/fuzz/FuzzInput.h"

#include "protocol/drive/ArduinoDevice.h"
#include "protocol/drive/Crc16.h"
#include "protocol/drive/OpenCrDevice.h"
#include "protocol/drive/RoboteqDevice.h"
#include "protocol/drive/VescDevice.h"

#include <memory>

using namespace hermes::drive;

namespace {

using Device = std::unique_ptr<MotorDevice>;

Device makeDevice(FuzzInput &in) {
    switch (in.take<std::uint8_t>() % 5) {
    case 0:
        return std::make_unique<ArduinoDevice>();
    case 1:
        return std::make_unique<OpenCrDevice>();
    case 2:
        return std::make_unique<RoboteqDevice>();
    case 3:
        return std::make_unique<VescDevice>(VescDevice::alone);
    default:
        return std::make_unique<VescDevice>(in.take<std::uint8_t>());
    }
}

Command takeCommand(FuzzInput &in, const MotorDevice &device) {
    Command command{Command::Kind(in.take<std::uint8_t>() % 6)};
    if (command.kind == Command::Kind::ReadSlow && device.slowReadings() == 0)
        command.kind = Command::Kind::ReadEncoders;
    const int numbers = command.kind == Command::Kind::SetUp      ? device.setupSteps()
                        : command.kind == Command::Kind::ReadSlow ? device.slowReadings()
                                                                  : 1;
    command.number = in.take<std::uint8_t>() % numbers;
    command.speeds = {in.take<std::int32_t>(), in.take<std::int32_t>()};
    if (in.flag())
        command.servo = in.setting(0.5);
    return command;
}

/// Any bytes, or a packet of a VESC or an OpenCR whose checksum is right.
std::string takeAnswer(FuzzInput &in) {
    const auto kind = in.take<std::uint8_t>() % 3;
    std::string text = in.bytes(in.take<std::uint8_t>()), packet;
    const auto raw = [](const std::string &bytes) {
        return reinterpret_cast<const std::uint8_t *>(bytes.data());
    };
    const auto add = [&packet](int byte) { packet += char(byte); };
    if (kind == 1) { // VESC
        add(2), add(int(text.size()));
        packet += text;
        const auto crc = crc16(raw(text), text.size());
        add(crc >> 8), add(crc), add(3);
    } else if (kind == 2) { // Dynamixel 2.0
        packet = std::string("\xFF\xFF\xFD\x00\xC8", 5);
        add(int(text.size() + 3) & 0xFF), add(int(text.size() + 3) >> 8), add(0x55);
        packet += text;
        const auto crc = crc16<0x8005>(raw(packet), packet.size());
        add(crc), add(crc >> 8);
    }
    return kind == 0 ? text : packet;
}

} // namespace

/// Any answers to any commands: what is read of a device is finite, and its memory bounded.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    FuzzInput in(data, size);
    const Device device = makeDevice(in);
    DeviceSettings settings;
    settings.timeout_s = 0.1 + in.take<std::uint8_t>() / 128.0;
    settings.mayLackTimeout = in.flag();
    device->configure(settings);
    Readings readings;
    for (int i = 0; in.left() > 0 && i < 200; ++i) {
        const Command command = takeCommand(in, *device);
        const Bytes request = device->bytes(command);
        FUZZ_REQUIRE(!request.empty() && request.size() < 64);
        FUZZ_REQUIRE(!device->nameOf(command).command.empty());
        device->reader().begin(request);
        auto result = ReplyReader::Result::Incomplete;
        for (int answers = 0; answers < 4 && result == ReplyReader::Result::Incomplete; ++answers) {
            for (const char byte : takeAnswer(in))
                if (result == ReplyReader::Result::Incomplete)
                    result = device->reader().feed(std::uint8_t(byte));
        }
        if (result == ReplyReader::Result::Incomplete)
            result = device->reader().silence();
        if (result != ReplyReader::Result::Done)
            continue;
        if (command.kind == Command::Kind::ReadSlow || command.kind == Command::Kind::SetUp)
            FUZZ_REQUIRE(device->take(command, readings).size() < 500);
        device->counts();
        FUZZ_REQUIRE(device->version().size() < 300);
        FUZZ_REQUIRE(std::isfinite(readings.battery_v) && std::isfinite(readings.temperature_c) &&
                     std::isfinite(readings.current_a[0]) && std::isfinite(readings.current_a[1]));
        FUZZ_REQUIRE(!std::isnan(device->timeout().seconds) && device->timeout().seconds >= 0);
    }
    return 0;
}
