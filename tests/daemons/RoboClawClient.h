#pragma once

#include "daemons/simulator/Drivetrain.h"

/// Big-endian.
inline QByteArray number(std::int64_t value, int bytes) {
    QByteArray text;
    for (int i = bytes - 1; i >= 0; --i)
        text += char(value >> 8 * i);
    return text;
}

inline std::int64_t integer(const QByteArray &data, int at, int size, bool isSigned = true) {
    std::int64_t value = 0;
    for (int i = 0; i < size; ++i)
        value = value << 8 | std::uint8_t(data[at + i]);
    return isSigned && value >> (8 * size - 1) ? value - (std::int64_t(1) << 8 * size) : value;
}

/// A host of emulated controllers, written from the published packet format alone; it shares no code with the
/// product.
class RoboClawClient {
public:
    explicit RoboClawClient(hermes::simulator::Drivetrain &drivetrain, int line = 0)
        : drivetrain_(&drivetrain)
        , line_(line) {}

    static std::uint16_t crcOf(const QByteArray &bytes) {
        std::uint32_t crc = 0;
        for (const char byte : bytes) {
            crc ^= std::uint32_t(std::uint8_t(byte)) << 8;
            for (int i = 0; i < 8; ++i)
                crc = (crc << 1) ^ ((crc & 0x8000) ? 0x11021 : 0);
        }
        return std::uint16_t(crc);
    }

    QByteArray send(const QByteArray &bytes, double gap = 0.02) {
        now_ += gap;
        QByteArray answer;
        for (const auto &part :
             drivetrain_->receive(line_, reinterpret_cast<const std::uint8_t *>(bytes.constData()),
                                  std::size_t(bytes.size()), now_)) {
            answer += QByteArray(reinterpret_cast<const char *>(part.bytes.data()), int(part.bytes.size()));
            delay = part.delay;
        }
        return answer;
    }
    bool write(int address, int command, const QByteArray &data = {}) {
        QByteArray packet = QByteArray(1, char(address)) + char(command) + data;
        packet += number(crcOf(packet), 2);
        return send(packet) == QByteArray("\xFF");
    }
    /// The data of the answer, or "silent", or "wrong CRC".
    QByteArray read(int address, int command, const QByteArray &argument = {}) {
        const QByteArray asked = QByteArray(1, char(address)) + char(command) + argument;
        const QByteArray answer = send(asked);
        if (answer.isEmpty())
            return "silent";
        const QByteArray data = answer.left(answer.size() - 2);
        return answer.right(2) == number(crcOf(asked + data), 2) ? data : QByteArray("wrong CRC");
    }
    bool speeds(int address, int m1, int m2, int acceleration) {
        return write(address, 40, number(acceleration, 4) + number(m1, 4) + number(m2, 4));
    }
    std::int64_t count(int address, int motor) { return integer(read(address, 78), motor * 4, 4); }

    double delay = 0; ///< of the last answer; seconds

private:
    hermes::simulator::Drivetrain *drivetrain_;
    int line_;
    double now_ = 0;
};

/// The drivetrain goes on by so many seconds.
inline void pass(hermes::simulator::Drivetrain &drivetrain, double seconds) {
    for (int i = 0; i < int(std::lround(seconds * 1000)); ++i)
        drivetrain.advance(0.001);
}

/// Gives all four motors a velocity control that reaches 150000 counts/s.
inline void setQpps(RoboClawClient &client) {
    for (const int address : {0x80, 0x81}) {
        for (const int command : {28, 29})
            QVERIFY(
                client.write(address, command,
                             number(0x4000, 4) + number(0x10000, 4) + number(0x8000, 4) + number(150000, 4)));
    }
}

/// For tests: a drive train, and a client at its first line.
class DrivetrainFixture {
protected:
    /// Makes both anew.
    void make(const hermes::simulator::Drivetrain::Options &options = {}) {
        drivetrain = hermes::simulator::Drivetrain(options);
        client = RoboClawClient(drivetrain);
    }

    hermes::simulator::Drivetrain drivetrain;
    RoboClawClient client{drivetrain};
};
