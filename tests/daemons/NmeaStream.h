#pragma once

#include "daemons/seriallogger/FixTracker.h"
#include "daemons/seriallogger/SerialMessages.h"
#include "protocol/wire/Fields.h"

/// A sentence with its checksum.
inline QByteArray sentence(const QByteArray &body) {
    const auto sum = hermes::nmea::checksum({body.constData(), std::size_t(body.size())});
    return '$' + body + '*' + QByteArray::number(sum, 16).rightJustified(2, '0') + "\r\n";
}

/// Feeds a tracker as a port does, and keeps what it gives.
class NmeaStream {
public:
    /// Each as the topic fix shows it.
    QList<QJsonObject> fixes;
    QList<int> givenAt_ms; ///< by the time of the bytes that made each fix known
    hermes::seriallogger::FixTracker tracker{hermes::nmea::ChecksumRule::Strict};

    void feed(int ms, const QByteArray &bytes) {
        pauseUntil(ms);
        now_ms_ = ms;
        tracker.feed({bytes.constData(), std::size_t(bytes.size())}, at(ms), sink());
    }
    /// Nothing came in, as a live port notices.
    void pauseUntil(int ms) {
        const auto until_ns = tracker.waitUntilMono_ns();
        if (!live || !until_ns || *until_ns > at(ms).mono_ns)
            return;
        now_ms_ = int(*until_ns / 1000000);
        tracker.pause(sink());
    }
    void finish() { tracker.pause(sink()); }
    bool live = false; ///< a clock runs; else only the bytes tell the time, as in a recording

private:
    static hermes::Moment at(int ms) { return {std::int64_t(ms) * 1000000, std::int64_t(ms) * 1000000}; }
    hermes::seriallogger::FixTracker::Sink sink() {
        return [this](const hermes::seriallogger::Fix &fix) {
            fixes << hermes::asJson(valuesOf(fix)).toObject();
            givenAt_ms << now_ms_;
        };
    }

    int now_ms_ = 0;
};
