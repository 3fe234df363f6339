#include "daemons/simulator/RplidarCapsules.h"
#include "daemons/simulator/ScannerEmulator.h"

#include <cmath>
#include <utility>

namespace hermes::simulator {

namespace {

struct Mode {
    std::uint8_t packet; ///< type of its answer
    double sample_us;
};

enum class Motor {
    Dtr, ///< which a pseudo-terminal has not: it turns
    Pwm, ///< it stands until A5 F0
    Rpm, ///< A5 A8
};

struct Type {
    const char *name;
    std::uint8_t model;
    Motor motor;
    unsigned typicalMode;
    std::vector<Mode> modes; ///< 0 is what 20 starts
};

// As fast as the line carries them.
const std::vector<Type> types{
    {"rplidar-a1", 0x18, Motor::Dtr, 2, {{0x81, 508}, {0x82, 254}, {0x84, 125}}},
    {"rplidar-a3", 0x31, Motor::Pwm, 2, {{0x81, 252}, {0x82, 125}, {0x84, 62.5}}},
    {"rplidar-c1", 0x41, Motor::Pwm, 0, {{0x81, 200}, {0x85, 200}}},
    {"rplidar-s2", 0x71, Motor::Rpm, 1, {{0x81, 100}, {0x85, 31.25}, {0x86, 31.25}}},
};

constexpr double fullPwm = 660, fullRpm = 600;

class RplidarEmulator : public ScannerEmulator {
public:
    RplidarEmulator(const ScannerModel &model, const ScannerOptions &options)
        : ScannerEmulator(model, options)
        , type_(typeOf(model, types)) {
        setSpeed(type_.motor == Motor::Pwm ? 0 : model.turns_hz);
    }

    bool tellsHealth() const override { return true; }

protected:
    void hear(std::uint8_t byte) override;
    bool isScanning() const override { return packet_ != 0 && (turns() || forced_) && !isBroken(); }
    void sample() override;
    void resume() override {
        setSpeed(model().turns_hz);
        scan(type_.modes[0]);
        unsend(); // it was answered long ago
    }

private:
    void obey(std::uint8_t request, std::string_view payload);
    void answer(std::uint8_t type, std::string_view bytes) { send(answerOf(type, bytes)); }
    void tellConf(std::string_view payload);
    void scan(const Mode &mode);

    const Type &type_;
    std::uint8_t packet_ = 0; ///< type of the packets that it sends; 0: none
    bool forced_ = false;     ///< scans even if the head stands
    bool begins_ = false;     ///< no packet was sent yet
    unsigned start_ = 0;      ///< angle of the first sample of a packet
    double slant_ = 0;        ///< of the sample before; degrees
    std::vector<RplidarPoint> points_;
};

unsigned number(std::string_view bytes, std::size_t at) {
    unsigned value = 0;
    for (std::size_t i = 0; i < 2 && at + i < bytes.size(); ++i)
        value |= unsigned(std::uint8_t(bytes[at + i])) << 8 * i;
    return value;
}

void RplidarEmulator::hear(std::uint8_t byte) {
    request_.push_back(char(byte));
    if (request_[0] != '\xA5')
        return request_.clear();
    if (request_.size() < 2)
        return;
    const std::uint8_t request = std::uint8_t(request_[1]);
    if (request < 0x80) {
        request_.clear();
        return obey(request, {});
    }
    if (request_.size() < 3 || request_.size() < 4 + std::size_t(std::uint8_t(request_[2])))
        return;
    const std::string whole = std::exchange(request_, {});
    if (xorOf(whole) == 0)
        obey(request, std::string_view(whole).substr(3, whole.size() - 4));
}

void RplidarEmulator::obey(std::uint8_t request, std::string_view payload) {
    const std::vector<Mode> &modes = type_.modes;
    if (request == 0xF0 || request == 0xA8) {
        if (type_.motor == (request == 0xF0 ? Motor::Pwm : Motor::Rpm))
            setSpeed(model().turns_hz * number(payload, 0) / (request == 0xF0 ? fullPwm : fullRpm));
        return;
    }
    packet_ = 0;
    if (request == 0x40) {
        mend();
        unsend();
        send("RP LIDAR System.\r\nFirmware Ver 1.29, HW Ver 7\r\n");
    } else if (request == 0x50) { // firmware 1.29, hardware 7
        answer(0x04, std::string{char(type_.model), 29, 1, 7} + "0123456789ABCDEF");
    } else if (request == 0x52) {
        answer(0x06, std::string{char(isBroken() ? 2 : 0), char(isBroken() ? 4 : 0), 0});
    } else if (request == 0x59) {
        answer(0x15, bytes16(unsigned(std::lround(modes[0].sample_us))) +
                         bytes16(unsigned(std::lround(modes[1].sample_us))));
    } else if (request == 0x84) {
        tellConf(payload);
    } else if (request == 0xFF) {
        answer(0xFF, bytes32(type_.motor == Motor::Pwm));
    } else if ((request == 0x20 || request == 0x21) && !isBroken()) {
        scan(modes[0]);
        forced_ = request == 0x21;
    } else if (request == 0x82 && payload.size() == 5 && !isBroken()) {
        const std::size_t number = std::uint8_t(payload[0]);
        if (number < modes.size())
            scan(number > 0 ? modes[number] : Mode{0x82, modes[1].sample_us});
    }
}

void RplidarEmulator::tellConf(std::string_view payload) {
    const unsigned type = number(payload, 0), wanted = number(payload, 4);
    const bool ofMode = type == 0x71 || type == 0x74 || type == 0x75 || type == 0x7F;
    if (payload.size() < 4 || (ofMode && wanted >= type_.modes.size()))
        return;
    const Mode &mode = type_.modes[ofMode ? wanted : 0];
    std::string value;
    if (type == 0x70)
        value = bytes16(unsigned(type_.modes.size()));
    else if (type == 0x7C)
        value = bytes16(type_.typicalMode);
    else if (type == 0x71)
        value = bytes32(std::uint32_t(std::lround(mode.sample_us * 256)));
    else if (type == 0x74)
        value = bytes32(std::uint32_t(std::lround(model().range_m * 256)));
    else if (type == 0x75)
        value = char(mode.packet);
    else if (type == 0x7F)
        value = rplidarPacket(mode.packet).mode + std::string(1, '\0');
    else if (type == 0x01)
        value = bytes16(unsigned(fullRpm)) + bytes16(unsigned(fullPwm));
    answer(0x20, std::string(payload.substr(0, 4)) + value);
}

void RplidarEmulator::scan(const Mode &mode) {
    send(answerOf(mode.packet, {}, rplidarPacket(mode.packet).bytes));
    packet_ = mode.packet;
    setPeriod(mode.sample_us * 1000);
    begins_ = true;
    forced_ = false;
    slant_ = 0;
    points_.clear();
}

void RplidarEmulator::sample() {
    const unsigned angle = stepOf(360 * 64); // 1/64 degree
    const bool needsNext = packet_ == 0x84;  // its last ranges begin from the first one of the next
    // A packet leaves one and a half samples after its last one.
    const double ready_ns = (needsNext ? 0.5 : 1.5) * period_ns();
    // Where a slanting ray goes depends on the range that it finds: on that of the sample before.
    const bool fine = packet_ == 0x81 || packet_ == 0x82; // quarters of a millimetre
    const int mm = range_mm(slant_ / 360 - turn(), fine ? 0x3FFF : 0xFFFF);
    if (packet_ == 0x81) {
        std::string packet(1, char((mm > 0 ? rplidarQuality : 0) << 2 | (isFirst() ? 1 : 2)));
        packet += bytes16(angle << 1 | 1);
        packet += bytes16(unsigned(mm) * 4);
        return send(packet, ready_ns);
    }
    start_ = points_.empty() ? angle : start_;
    points_.push_back({mm, slant_});
    slant_ = rplidarSlant_deg(packet_, mm);
    const std::size_t samples = rplidarPacket(packet_).samples;
    if (points_.size() < samples + needsNext)
        return;
    send(encodeRplidar(packet_, start_ | (begins_ ? 0x8000 : 0), std::uint32_t(clock_us()), points_),
         ready_ns);
    begins_ = false;
    points_.erase(points_.begin(), points_.begin() + std::ptrdiff_t(samples));
    start_ = angle;
}

} // namespace

const ScannerModel::Make makeRplidar = makeOf<RplidarEmulator>;

} // namespace hermes::simulator
