#include "protocol/scan/Ydlidar.h"

#include "protocol/scan/LittleEndian.h"

#include <cmath>
#include <cstdio>

namespace hermes::scan {
namespace {

constexpr std::size_t packetHead = 10, timePacket = 8, answerHead = 7;
constexpr int maxCount = 80, usualCount = 40; // beams of a packet
constexpr int wrongWidth = 20;                // so many wrong checksums in a row are no noise
constexpr double tolerance = 5;               // beams that packets may lie beside each other

} // namespace

Ydlidar::Ydlidar(Kind kind, const ScannerModel &model, RevolutionAssembler &revolutions)
    : ScannerProtocol(revolutions)
    , kind_(kind)
    , isOneWay_(model.isOneWay)
    , motor_(model.motor)
    , byte_ns_(1e10 / model.baud)
    , beamSize_(kind == Kind::Tmini ? 3 : 2)
    , clock_(1e9 / model.samples_hz, tolerance, usualCount) {
    identity_.model = "YDLIDAR";
}

void Ydlidar::jump() {
    ScannerProtocol::jump();
    restart();
}

void Ydlidar::restart() {
    revolutions_.jump();
    clock_.jump();
    skipped_ = 1; // it may begin within a packet, which is no damage
}

std::optional<ScannerProtocol::Request> Ydlidar::request(int step) const {
    switch (isOneWay_ && step != Wake ? Scan : step) {
    case Wake: {
        Request wake{Until::Time, isOneWay_ ? std::string() : std::string(1, '\0'), 20};
        if (motor_ == Motor::DtrHigh) {
            wake.wait_ms = 500;
            wake.dtr = true;
        }
        return wake;
    }
    case Stop:
        return Request{Until::Silence, "\xA5\x65"};
    case Info:
        return Request{Until::Answer, "\xA5\x90", 300};
    case Health:
        return Request{Until::Answer, "\xA5\x92", 500};
    case Reset:
        return needsReset_ ? Request{Until::Time, "\xA5\x80", 1000} : Request();
    case Begin:
        return Request{Until::Answer, "\xA5\x60", 500};
    default:
        return {};
    }
}

std::size_t Ydlidar::take(std::string_view bytes, const Arrival &arrival) {
    const auto first = std::uint8_t(bytes[0]);
    const std::size_t size = first == 0xA5   ? takeAnswer(bytes)
                             : first == 0xAA ? takePacket(bytes, arrival)
                                             : 0;
    if (size == 0)
        counts_.damaged += skipped_++ % (packetHead + std::size_t(clock_.fullBeams()) * beamSize_) == 0;
    return size;
}

std::size_t Ydlidar::takeAnswer(std::string_view bytes) {
    const auto *const data = reinterpret_cast<const std::uint8_t *>(bytes.data());
    if (bytes.size() > 1 && data[1] != 0x5A)
        return 0;
    if (bytes.size() < answerHead)
        return more;
    const std::uint32_t length = longWord(data + 2);
    const int form = data[6];
    if (form == 0x81 && length == 0x40000005) { // packets follow
        restart();
        answered(Begin);
        return answerHead;
    }
    if (!(form == 0x04 && (length == 20 || length == 4)) && !(form == 0x06 && length == 3)) {
        if (isMeasuring() && skipped_ == 0)
            trouble_ = "the head of the scanner is blocked";
        return 0;
    }
    if (bytes.size() < answerHead + length)
        return more;
    if (form == 0x06) {
        needsReset_ = takeHealth(data + answerHead);
        answered(Health);
    } else if (length == 20) {
        takeInfo(data + answerHead);
    }
    return answerHead + length;
}

void Ydlidar::takeInfo(const std::uint8_t *data) {
    char text[40];
    std::snprintf(text, sizeof text, "YDLIDAR (model %d)", data[0]);
    identity_.model = text;
    std::snprintf(text, sizeof text, "%d.%d", data[2], data[1]);
    identity_.firmware = text;
    identity_.serial.clear();
    for (int i = 4; i < 20; ++i) { // a digit each
        std::snprintf(text, sizeof text, "%X", unsigned(data[i]));
        identity_.serial += text;
    }
    answered(Info);
}

/// The exclusive or of all words but its own; an intensity of one byte counts alone.
bool Ydlidar::isRight(const std::uint8_t *bytes, int count) const {
    int sum = word(bytes) ^ word(bytes + 2) ^ word(bytes + 4) ^ word(bytes + 6);
    for (const std::uint8_t *beam = bytes + packetHead; count > 0; --count, beam += beamSize_)
        sum ^= beamSize_ == 3 ? beam[0] ^ word(beam + 1) : word(beam);
    return sum == word(bytes + 8);
}

std::size_t Ydlidar::takePacket(std::string_view bytes, const Arrival &arrival) {
    const auto *const data = reinterpret_cast<const std::uint8_t *>(bytes.data());
    if (bytes.size() < 2)
        return more;
    if (data[1] == 0x66) // a time, that the host does not need
        return bytes.size() < timePacket ? more : data[timePacket - 1] == 0 ? timePacket : 0;
    if (data[1] != 0x55)
        return 0;
    if (bytes.size() < packetHead)
        return more;
    const int count = data[3];
    if (count < 1 || count > maxCount || (data[4] & data[6] & 1) == 0)
        return 0;
    const std::size_t size = packetHead + std::size_t(count) * beamSize_;
    if (bytes.size() < size)
        return more;
    if (!isRight(data, count)) {
        if (++wrong_ >= wrongWidth)
            trouble_ =
                "the checksums of the packets are wrong: another model, whose intensities have another "
                "width, or a bad line";
        return 0;
    }
    wrong_ = 0;
    const double first_deg = (word(data + 4) >> 1) / 64.0;
    const double width_deg = std::fmod((word(data + 6) >> 1) / 64.0 - first_deg + 360, 360);
    const auto wire_ns = std::int64_t(double(bytes.size()) * byte_ns_);
    const SampleClock::Time end = clock_.take({first_deg, count, skipped_ > 0, arrival.mono_ns - wire_ns});
    skipped_ = 0;
    revolutions_.setClockBound(end.bound_ns);
    if (end.slips)
        revolutions_.slip();
    if (end.lost > 0)
        revolutions_.lose(end.lost);
    if (count > 1 && width_deg > 0 && width_deg < 180)
        step_deg_ = width_deg / (count - 1);
    for (int i = 0; i < count; ++i)
        addBeam(data + packetHead + std::size_t(i) * beamSize_, first_deg + i * step_deg_,
                end.stamp_ns - std::int64_t((count - 1 - i) * clock_.sample_ns()));
    clock_.expect(first_deg + count * step_deg_, step_deg_);
    measured(arrival);
    return size;
}

/// Laser and receiver of those that triangulate lie beside each other: the nearer, the further turned.
void Ydlidar::addBeam(const std::uint8_t *beam, double head_deg, std::int64_t stamp_ns) {
    int range = word(beam + beamSize_ - 2);
    if (kind_ == Kind::Tmini)
        range = range & 2 ? 0 : range & 0xFFFC; // marked: a reflection or the sun, no obstacle
    const double range_mm = kind_ == Kind::TimeOfFlight ? range : range * 0.25;
    double angle_deg = head_deg;
    if (kind_ == Kind::Triangulation && range > 0)
        angle_deg += std::atan(21.8 * (155.3 - range_mm) / (155.3 * range_mm)) * 57.29577951308232;
    revolutions_.addClockwise(std::fmod(head_deg, 360), angle_deg, float(range_mm * 1e-3),
                              kind_ == Kind::Tmini ? beam[0] : std::uint8_t(0), stamp_ns);
}

std::string Ydlidar::farewell() const {
    return isOneWay_ ? std::string() : "\xA5\x65";
}

} // namespace hermes::scan
