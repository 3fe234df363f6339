#pragma once

#include "common/Result.h"
#include "common/ros/Mapping.h"

#include <QObject>
#include <QStringList>

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

struct ddsi_sertype;

namespace hermes::ros2 {

/// Of an endpoint or participant, as on the wire.
using Guid = std::array<std::uint8_t, 16>;

using ros::Quality;

struct ParticipantOptions {
    int domain = 0;
    QStringList networks; ///< names or addresses of interfaces; none: this host alone
    QStringList peers;    ///< hosts that are asked for where multicast does not reach
    int fragmentBytes = 63000;
    QString enclave; ///< folder of a keystore, as SROS2 lays it out; empty: everybody is believed
};

class Participant;

/// Writes one topic. It lives no longer than its participant.
class Writer {
public:
    ~Writer();
    Writer(const Writer &) = delete;
    Writer &operator=(const Writer &) = delete;

    /// cdr: with its encapsulation. Never waits for readers.
    void write(std::string_view cdr);
    int readers() const { return readers_; } ///< that are matched
    const Guid &guid() const { return guid_; }

private:
    friend class Participant;
    Writer() = default;

    int entity_ = 0, topic_ = 0;
    const ddsi_sertype *type_ = nullptr;
    Guid guid_{};
    std::atomic<int> readers_{0};
    QObject *context_ = nullptr;
    std::function<void()> matched_;
};

/// Reads one topic. It lives no longer than its participant.
class Reader {
public:
    struct Sample {
        std::string_view cdr; ///< with its encapsulation
        Guid writer{};
        double stamp = 0;    ///< when it was written by the clock of who wrote it, seconds since the epoch
        double age_s = 0;    ///< how old it was then, where it tells that
        QByteArray userData; ///< of the writer
    };
    using Callback = std::function<void(const Sample &)>;

    ~Reader();
    Reader(const Reader &) = delete;
    Reader &operator=(const Reader &) = delete;

    const Guid &guid() const { return guid_; }

private:
    friend class Participant;
    Reader() = default;
    void take();
    void tellWriter(std::uint64_t handle, Sample &sample) const;

    int entity_ = 0, topic_ = 0;
    Guid guid_{};
    std::atomic<bool> isCalled_{false}; ///< take() will be
    std::unique_ptr<QObject> context_;
    Callback callback_;
};

/// One participant of a DDS domain, by Eclipse Cyclone DDS. Its callbacks come in the thread that made it.
/// One of a domain in a process at a time.
class Participant {
public:
    static Result<std::unique_ptr<Participant>> open(const ParticipantOptions &options);
    ~Participant();
    Participant(const Participant &) = delete;
    Participant &operator=(const Participant &) = delete;

    /// topic: as DDS knows it, "rt/scan". type: as ROS 2 does, "sensor_msgs/msg/LaserScan". userData: of the
    /// endpoint, "typehash=RIHS01_...;", or none. matched is called when the number of readers has changed.
    Result<std::unique_ptr<Writer>> write(const QString &topic, const std::string &type,
                                          const Quality &quality, const QByteArray &userData = {},
                                          std::function<void()> matched = {});
    Result<std::unique_ptr<Reader>> read(const QString &topic, const std::string &type,
                                         const Quality &quality, Reader::Callback callback,
                                         const QByteArray &userData = {});
    const Guid &guid() const { return guid_; }

private:
    Participant() = default;
    Result<int> topic(const QString &name, const std::string &type, ddsi_sertype *&made);

    int domain_ = 0, entity_ = 0;
    Guid guid_{};
    QObject context_;
};

/// The configuration of Cyclone DDS; error: an option that cannot be used.
Result<QString> configurationOf(const ParticipantOptions &options);

} // namespace hermes::ros2
