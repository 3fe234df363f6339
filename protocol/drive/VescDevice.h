#pragma once

#include "protocol/drive/MotorDevice.h"

namespace hermes::drive {

/// A pair of VESCs: M1 is on the wire, M2 on the CAN bus of the first one. Packets have a checksum and big
/// endian numbers. What sets something is not answered: each of both is asked for its id in the same write,
/// and who answers has heard what came before. It counts six in an electrical turn. (vedderb/bldc,
/// comm/packet.c and commands.c, datatypes.h, timeout.c)
///
/// Its time-out is a part of its app configuration. That is read, and never written: it has hundreds of
/// values. Then it brakes with the current that stands there; with 0 its motors are released. To stand it is
/// told a brake current: at a speed below s_pid_min_erpm, as 0 is, it would release its motors.
class VescDevice : public SelfReadingDevice {
public:
    static constexpr int usualBaud = 115200;
    static constexpr int alone = 255;                 ///< the id of the second one where there is none
    static constexpr std::size_t longestPacket = 520; ///< that it takes; its own ones may be longer
    static constexpr double longestTimeout_s = 2;     ///< that is driven
    static constexpr int erpmPerCount = 60 / 6;       ///< electrical turns a minute at one count a second

    /// second: id of M2 on the CAN bus.
    explicit VescDevice(int second)
        : second_(second)
        , motors_(second == alone ? 1 : 2) {}

    bool configure(const DeviceSettings &settings) override;
    DeviceTimeout timeout() const override;
    int setupSteps() const override { return 2 * motors_ + 3; }
    int slowReadings() const override { return 1; }

    Bytes bytes(const Command &command) const override;
    Name nameOf(const Command &command) const override;
    std::string take(const Command &command, Readings &readings) override;
    std::array<std::uint32_t, 2> counts() const override;

private:
    /// The first bytes of an answer, and how many there are.
    struct Answer {
        std::array<std::uint8_t, 32> bytes{};
        std::size_t size = 0;
        std::uint32_t number(std::size_t at, int count = 4) const;
        double half(std::size_t at) const { return std::int16_t(number(at, 2)); }
    };

    void begin(const Bytes &request) override;
    Result feed(std::uint8_t byte) override;
    Result takeAnswer();
    void push(Bytes &bytes, int motor, std::uint8_t code, std::uint32_t argument = 0, int size = 0) const;
    void pushSpeed(Bytes &bytes, int motor, double speed) const;
    std::string takeTimeout(int motor);
    void takeValues(Readings &readings) const;

    const int second_, motors_;
    DeviceSettings settings_;
    double timeout_s_ = settings_.timeout_s; // the longer one
    bool coasts_ = false;

    std::uint8_t code_ = 0, awaited_ = 0; // bits of M1 and M2
    std::uint32_t mask_ = 0;              // which values
    std::size_t place_ = 0, header_ = 0;
    std::uint16_t crc_ = 0;
    Answer answer_;
    std::array<Answer, 2> answers_;
};

} // namespace hermes::drive
