#include "protocol/scan/Rplidar.h"

#include "protocol/scan/LittleEndian.h"

#include <cstdio>
#include <initializer_list>
#include <iterator>
#include <utility>

namespace hermes::scan {
namespace {

constexpr std::size_t headSize = 7; // of an answer
constexpr std::uint32_t maxAnswer = 64;
constexpr std::uint32_t streams = 0x40000000; // packets follow the answer, of that size
// What the configuration (request 84) is asked for.
constexpr std::uint8_t samplePeriod = 0x71, answerForm = 0x75, typicalMode = 0x7C;

bool isPeriod(double sample_us) {
    return sample_us > 1 && sample_us < 1e5;
}

/// With its length and the exclusive or of all before.
std::string withPayload(std::uint8_t command, std::initializer_list<int> payload) {
    std::string text{char(0xA5), char(command), char(payload.size())};
    for (const int byte : payload)
        text += char(byte);
    char sum = 0;
    for (const char byte : text)
        sum = char(sum ^ byte);
    return text + sum;
}

} // namespace

Rplidar::Rplidar(int baud, bool turnsByDtr, RevolutionAssembler &revolutions)
    : ScannerProtocol(revolutions)
    , packets_(baud, revolutions)
    , turnsByDtr_(turnsByDtr) {}

std::string Rplidar::prerequisite() const {
    char text[32];
    std::snprintf(text, sizeof text, "%02x %.4f", unsigned(packets_.form()), packets_.sample_us());
    return packets_.form() == 0 ? std::string() : text;
}

void Rplidar::prepare(const std::string &prerequisite) {
    unsigned form = 0;
    double sample_us = 0;
    if (std::sscanf(prerequisite.c_str(), "%x %lf", &form, &sample_us) == 2 &&
        RplidarPackets::isForm(int(form)) && isPeriod(sample_us))
        packets_.begin(int(form), sample_us);
}

void Rplidar::jump() {
    ScannerProtocol::jump();
    packets_.jump();
    skipped_ = 1; // it may begin within a packet, which is no damage
}

bool Rplidar::hasModes() const {
    return firmware_ >= 124 || model_ >> 4 >= 4;
}

std::optional<ScannerProtocol::Request> Rplidar::request(int step) const {
    const std::optional<bool> dtr = turnsByDtr_ ? std::optional(false) : std::nullopt;
    const auto ask = [](std::string text) { return Request{Until::Answer, std::move(text), 500}; };
    const int low = mode_ & 0xFF, high = mode_ >> 8;
    switch (step) {
    case Stop:
        return Request{Until::Silence, "\xA5\x25", 0, dtr};
    case Info:
        return Request{Until::Answer, "\xA5\x50", 300};
    case Health:
        return ask("\xA5\x52");
    case Reset:
        return needsReset_ ? Request{Until::Time, "\xA5\x40", 1000} : Request();
    case MotorKind: // the A1 does not know this request
        return isOfS() ? Request() : Request{Until::Time, withPayload(0xFF, {0, 0, 0, 0}), 200};
    case Motor:
        return Request{Until::Time,
                       isOfS()   ? withPayload(0xA8, {0x58, 0x02}) // 600 revolutions a minute
                       : hasPwm_ ? withPayload(0xF0, {0x94, 0x02})
                                 : std::string(),
                       20, dtr};
    case Mode:
        return hasModes() ? ask(withPayload(0x84, {typicalMode, 0, 0, 0})) : Request();
    case Period:
        return hasModes() ? ask(withPayload(0x84, {samplePeriod, 0, 0, 0, low, high})) : Request();
    case Form:
        return hasModes() ? ask(withPayload(0x84, {answerForm, 0, 0, 0, low, high})) : Request();
    case Rates:
        return hasModes() ? Request() : ask("\xA5\x59");
    case Express: // some old firmware does not know this request
        return form_ == 0x81 ? Request()
                             : Request{hasModes() ? Until::Answer : Until::Time,
                                       withPayload(0x82, {low, 0, 0, 0, 0}), 500};
    case Standard:
        return packets_.form() != 0 ? Request() : ask("\xA5\x20");
    default:
        return {};
    }
}

/// Answers may stand between packets, and the beginning of either within the other's data: whatever is
/// neither is skipped byte by byte.
std::size_t Rplidar::take(std::string_view bytes, const Arrival &arrival) {
    if (const std::size_t answer = takeAnswer(bytes); answer > 0)
        return answer;
    const std::size_t size = packets_.size();
    if (size > 0 && bytes.size() < packets_.needed())
        return more;
    const auto *const data = reinterpret_cast<const std::uint8_t *>(bytes.data());
    if (size == 0 || !packets_.isPacket(data)) {
        if (size > 0) {
            counts_.damaged += skipped_++ % size == 0;
            packets_.lose();
        }
        return 0;
    }
    skipped_ = 0;
    packets_.take(data, arrival, bytes.size());
    measured(arrival);
    return size;
}

std::size_t Rplidar::takeAnswer(std::string_view bytes) {
    const auto *const data = reinterpret_cast<const std::uint8_t *>(bytes.data());
    if (data[0] != 0xA5 || (bytes.size() > 1 && data[1] != 0x5A))
        return 0;
    if (bytes.size() < headSize)
        return more;
    const std::uint32_t length = longWord(data + 2);
    const int form = data[6];
    if (RplidarPackets::isForm(form)) {
        if (length != (streams | RplidarPackets::sizeOf(form))) // a capsule may begin alike
            return 0;
        const double told_us = sample_us_ > 0 ? sample_us_ : rates_us_[form == 0x81 ? 0 : 1];
        packets_.begin(form, isPeriod(told_us) ? told_us : packets_.sample_us());
        skipped_ = 1;
        answered(Express);
        answered(Standard);
        return headSize;
    }
    const bool isKnown = (form == 0x04 && length == 20) || (form == 0x06 && length == 3) ||
                         (form == 0x15 && length == 4) || (form == 0xFF && length == 4) ||
                         (form == 0x20 && length > 4 && length <= maxAnswer);
    if (!isKnown)
        return 0;
    if (bytes.size() < headSize + length)
        return more;
    const std::uint8_t *const value = data + headSize;
    if (form == 0x04) {
        takeInfo(value);
    } else if (form == 0x06) {
        needsReset_ = takeHealth(value);
        answered(Health);
    } else if (form == 0x15) {
        rates_us_ = {word(value), word(value + 2)};
        answered(Rates);
    } else if (form == 0xFF) {
        hasPwm_ = value[0] & 1;
        answered(MotorKind);
    } else {
        takeConf(longWord(value), value + 4, length - 4);
    }
    return headSize + length;
}

/// It is asked only while it is to be silent: no packets come until it has begun to scan anew.
void Rplidar::takeInfo(const std::uint8_t *data) {
    static constexpr const char *series[] = {"", "A1", "A2", "A3", "C1", "", "S1", "S2", "S3"};
    model_ = data[0];
    firmware_ = data[2] * 100 + data[1];
    const auto major = std::size_t(model_ >> 4);
    char text[48];
    std::snprintf(text, sizeof text, "RPLIDAR %s (model %02x)",
                  major < std::size(series) ? series[major] : "", unsigned(model_));
    identity_.model = text;
    std::snprintf(text, sizeof text, "%d.%02d", firmware_ / 100, firmware_ % 100);
    identity_.firmware = text;
    identity_.serial.clear();
    for (int i = 4; i < 20; ++i) {
        std::snprintf(text, sizeof text, "%02X", unsigned(data[i]));
        identity_.serial += text;
    }
    packets_.begin(0, packets_.sample_us());
    answered(Info);
}

void Rplidar::takeConf(std::uint32_t what, const std::uint8_t *value, std::size_t size) {
    if (what == typicalMode && size >= 2) {
        mode_ = word(value);
        answered(Mode);
    } else if (what == samplePeriod && size >= 4) {
        sample_us_ = longWord(value) / 256.0;
        answered(Period);
    } else if (what == answerForm && RplidarPackets::isForm(value[0])) {
        form_ = value[0];
        answered(Form);
    }
}

std::string Rplidar::farewell() const {
    return ScannerProtocol::farewell() + (isOfS()   ? withPayload(0xA8, {0, 0})
                                          : hasPwm_ ? withPayload(0xF0, {0, 0})
                                                    : std::string());
}

} // namespace hermes::scan
