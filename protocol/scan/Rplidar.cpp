#include "protocol/scan/Rplidar.h"

#include <cstdio>

namespace hermes::scan {
namespace {

constexpr std::size_t headSize = 7; // of an answer
constexpr std::size_t maxAnswer = 64;
constexpr std::int64_t ms = 1000000;
constexpr int maxAttempts = 3;
// Steps of the configuration (request 84) and what they ask for.
constexpr std::uint32_t samplePeriod = 0x71, answerForm = 0x75, typicalMode = 0x7C;

std::uint8_t at(std::string_view bytes, std::size_t index) {
    return std::uint8_t(bytes[index]);
}

std::uint32_t number(std::string_view bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4 && i < bytes.size(); ++i)
        value |= std::uint32_t(at(bytes, i)) << 8 * i;
    return value;
}

/// With its length and the exclusive or of all before.
std::string withPayload(std::uint8_t command, std::initializer_list<std::uint8_t> payload) {
    std::string text{char(0xA5), char(command), char(payload.size())};
    for (const std::uint8_t byte : payload)
        text += char(byte);
    char sum = 0;
    for (const char byte : text)
        sum = char(sum ^ byte);
    return text + sum;
}

std::string plain(std::uint8_t command) {
    return {char(0xA5), char(command)};
}

std::string ask(std::uint32_t what) {
    return withPayload(0x84, {std::uint8_t(what), 0, 0, 0});
}

std::string ask(std::uint32_t what, int mode) {
    return withPayload(0x84, {std::uint8_t(what), 0, 0, 0, std::uint8_t(mode), std::uint8_t(mode >> 8)});
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
        RplidarPackets::isForm(int(form)) && sample_us > 1 && sample_us < 1e5)
        packets_.begin(int(form), sample_us);
}

void Rplidar::jump() {
    buffer_.clear();
    packets_.jump();
}

/// Answers may stand between packets, and the beginning of either within the other's data: whatever is
/// neither is skipped byte by byte.
void Rplidar::feed(std::string_view bytes, const Arrival &arrival) {
    lastBytes_ns_ = arrival.mono_ns;
    buffer_ += bytes;
    std::size_t used = 0;
    while (buffer_.size() > used) {
        const std::string_view rest = std::string_view(buffer_).substr(used);
        const std::size_t answer = takeAnswer(rest);
        if (answer == std::string_view::npos)
            break; // more of it is to come
        if (answer > 0) {
            used += answer;
            continue;
        }
        const std::size_t size = packets_.size();
        if (size > 0 && rest.size() < packets_.needed())
            break;
        const auto *const data = reinterpret_cast<const std::uint8_t *>(rest.data());
        if (size == 0 || !packets_.isPacket(data)) {
            ++used;
            ++counts_.skippedBytes;
            if (packetsOfScan_ > 0 && skipped_++ == 0)
                packets_.lose(0);
            continue;
        }
        if (const std::size_t skipped = std::exchange(skipped_, 0); skipped > 0) {
            counts_.damaged += (skipped + size - 1) / size;
            packets_.lose((skipped + size - 1) / size);
        }
        packets_.take(data, arrival, rest.size() - size);
        ++counts_.packets;
        ++packetsOfScan_;
        lastPacket_ns_ = arrival.mono_ns;
        used += size;
    }
    buffer_.erase(0, used);
}

/// Bytes of the answer that begins there: 0 when none does, npos when its end has not come.
std::size_t Rplidar::takeAnswer(std::string_view bytes) {
    if (at(bytes, 0) != 0xA5 || (bytes.size() > 1 && at(bytes, 1) != 0x5A))
        return 0;
    if (bytes.size() < headSize)
        return std::string_view::npos;
    const std::uint32_t length = number(bytes.substr(2)) & 0x3FFFFFFF;
    const int form = at(bytes, 6);
    if (RplidarPackets::isForm(form)) {
        const bool isStream = at(bytes, 5) >> 6 == 1;
        if (!isStream)
            return 0;
        const double told_us = sample_us_ > 0 ? sample_us_ : rates_us_[form == 0x81 ? 0 : 1];
        packets_.begin(form, told_us > 0 ? told_us : packets_.sample_us());
        packetsOfScan_ = skipped_ = 0;
        isAnswered_ = isAnswered_ || step_ == Step::Begin;
        return headSize;
    }
    const bool isKnown = (form == 0x04 && length == 20) || (form == 0x06 && length == 3) ||
                         (form == 0x15 && length == 4) || (form == 0xFF && length == 4) ||
                         (form == 0x20 && length >= 4 && length <= maxAnswer);
    if (!isKnown)
        return 0;
    if (bytes.size() < headSize + length)
        return std::string_view::npos;
    const std::string_view data = bytes.substr(headSize, length);
    if (form == 0x04)
        takeInfo(data);
    else if (form == 0x06)
        takeHealth(data);
    else if (form == 0x15)
        rates_us_ = {int(number(data) & 0xFFFF), int(number(data) >> 16)};
    else if (form == 0xFF)
        hasPwm_ = number(data) & 1;
    else
        takeConf(data);
    const bool isAwaited =
        (form == 0x04 && step_ == Step::Info) || (form == 0x06 && step_ == Step::Health) ||
        (form == 0x15 && step_ == Step::Rates) || (form == 0xFF && step_ == Step::MotorKind) ||
        (form == 0x20 && (step_ == Step::Mode || step_ == Step::Period || step_ == Step::Form));
    isAnswered_ = isAnswered_ || isAwaited;
    return headSize + length;
}

void Rplidar::takeInfo(std::string_view data) {
    static constexpr const char *series[] = {"", "A1", "A2", "A3", "C1", "", "S1", "S2", "S3"};
    model_ = at(data, 0);
    firmware_ = at(data, 2) * 100 + at(data, 1);
    const auto major = std::size_t(model_ >> 4);
    char text[48];
    std::snprintf(text, sizeof text, "RPLIDAR %s (model %02x)",
                  major < std::size(series) ? series[major] : "", unsigned(model_));
    identity_.model = text;
    std::snprintf(text, sizeof text, "%d.%02d", firmware_ / 100, firmware_ % 100);
    identity_.firmware = text;
    identity_.serial.clear();
    for (std::size_t i = 4; i < 20; ++i) {
        std::snprintf(text, sizeof text, "%02X", unsigned(at(data, i)));
        identity_.serial += text;
    }
}

void Rplidar::takeHealth(std::string_view data) {
    needsReset_ = at(data, 0) == 2;
    char text[80];
    std::snprintf(text, sizeof text, "the scanner tells of a fault, code %04X%s",
                  number(data.substr(1)) & 0xFFFF, needsReset_ ? "; it is reset" : "");
    if (at(data, 0) != 0)
        problem_ = text;
}

void Rplidar::takeConf(std::string_view data) {
    const std::uint32_t what = number(data);
    const std::string_view value = data.substr(4);
    if (what == typicalMode && value.size() >= 2)
        mode_ = int(number(value));
    else if (what == samplePeriod && value.size() >= 4)
        sample_us_ = number(value) / 256.0;
    else if (what == answerForm && !value.empty() && RplidarPackets::isForm(at(value, 0)))
        form_ = at(value, 0);
}

bool Rplidar::hasModes() const {
    return firmware_ >= 124 || model_ >> 4 >= 4;
}

void Rplidar::opened(std::int64_t mono_ns) {
    buffer_.clear();
    packets_.jump();
    attempts_ = 0;
    step_ = Step::Stop;
    stepSince_ns_ = 0; // it is to be sent yet
    lastBytes_ns_ = mono_ns;
}

Rplidar::Step Rplidar::after(Step step) const {
    switch (step) {
    case Step::Health:
        return needsReset_ ? Step::Reset : Step::MotorKind;
    case Step::Reset:
        return Step::Stop;
    case Step::MotorKind:
        return Step::Motor;
    case Step::Motor:
        return hasModes() ? Step::Mode : Step::Rates;
    case Step::Form:
    case Step::Rates:
        return Step::Begin;
    default:
        return Step(int(step) + 1);
    }
}

std::string Rplidar::request() const {
    switch (step_) {
    case Step::Stop:
        return plain(0x25);
    case Step::Info:
        return plain(0x50);
    case Step::Health:
        return plain(0x52);
    case Step::Reset:
        return plain(0x40);
    case Step::MotorKind:
        return withPayload(0xFF, {0, 0, 0, 0});
    case Step::Motor:
        if (model_ >> 4 >= 6)
            return withPayload(0xA8, {0x58, 0x02}); // 600 revolutions a minute
        return hasPwm_ ? withPayload(0xF0, {0x94, 0x02}) : std::string();
    case Step::Mode:
        return ask(typicalMode);
    case Step::Period:
        return ask(samplePeriod, mode_);
    case Step::Form:
        return ask(answerForm, mode_);
    case Step::Rates:
        return plain(0x59);
    case Step::Begin:
        return form_ == 0x81 ? plain(0x20) : withPayload(0x82, {std::uint8_t(mode_), 0, 0, 0, 0});
    default:
        return {};
    }
}

void Rplidar::fail(const std::string &problem) {
    problem_ = problem;
    ++attempts_;
}

HostAction Rplidar::begin(Step step, std::int64_t mono_ns) {
    step_ = step;
    stepSince_ns_ = mono_ns;
    isAnswered_ = false;
    HostAction action;
    action.send = request();
    if (turnsByDtr_ && (step == Step::Stop || step == Step::Motor))
        action.dtr = false;
    if (step == Step::Stop) {
        buffer_.clear();
        packets_.begin(0, packets_.sample_us());
        lastBytes_ns_ = mono_ns;
    }
    return action;
}

HostAction Rplidar::next(std::int64_t mono_ns) {
    const std::int64_t since_ns = mono_ns - stepSince_ns_;
    if (stepSince_ns_ == 0)
        return begin(Step::Stop, mono_ns);
    switch (step_) {
    case Step::Stop: // what it streamed before is to end first
        if (mono_ns - lastBytes_ns_ < 100 * ms && since_ns < 1000 * ms)
            return {};
        return begin(Step::Info, mono_ns);
    case Step::Reset:
        return since_ns < 1000 * ms ? HostAction() : begin(Step::Stop, mono_ns);
    case Step::Motor:
        return since_ns < 20 * ms ? HostAction() : begin(after(step_), mono_ns);
    case Step::MotorKind: // the A1 does not know this request
        if (!isAnswered_ && since_ns < 200 * ms && model_ >> 4 < 6)
            return {};
        return begin(Step::Motor, mono_ns);
    case Step::Scan:
        if (packetsOfScan_ > 0 && mono_ns - lastPacket_ns_ < 1000 * ms) {
            attempts_ = 0;
            problem_.clear();
            return {};
        }
        if (since_ns < 3000 * ms && packetsOfScan_ == 0) // the motor comes to its speed
            return {};
        fail("no measurement came for a second");
        break;
    default:
        if (isAnswered_)
            return begin(after(step_), mono_ns);
        if (since_ns < 500 * ms)
            return {};
        if (step_ == Step::Begin && form_ != 0x81 && !hasModes()) { // a firmware without express scans
            form_ = 0x81;
            return begin(Step::Begin, mono_ns);
        }
        fail(step_ == Step::Info
                 ? "the scanner does not answer: another device, another baud rate, or too little "
                   "power"
                 : "the scanner stopped answering");
    }
    HostAction action = begin(Step::Stop, mono_ns);
    if (attempts_ >= maxAttempts) {
        attempts_ = 0;
        action.reopen = true;
    }
    return action;
}

} // namespace hermes::scan
