#pragma once

#include "common/interface/SerialInterface.h"

#include <QJsonObject>
#include <QSet>
#include <deque>
#include <functional>
#include <map>
#include <memory>

namespace hermes::softwaretrigger {

/// The serial lines that triggers write to, one port a URL; opened again by themselves. RTS and DTR are low
/// from the opening on where a trigger pulses them.
class SerialLines : public QObject {
    Q_OBJECT
public:
    using Signal = SerialInterface::Signal;
    using Done = std::function<void(const Result<QJsonValue> &)>;
    /// URL -> the signals that are pulsed.
    using Wanted = std::map<QString, QSet<int>>;

    explicit SerialLines(QObject *parent)
        : QObject(parent) {}
    ~SerialLines() override { use({}); }

    /// Opens what is wanted and not open yet, closes what is not wanted.
    void use(const Wanted &wanted);
    /// Done when the system has taken the last byte; fails when the line is not open, takes no more, or does
    /// not within two seconds (flow control).
    void send(const QString &url, const QByteArray &bytes, const Done &done);
    Result<void> set(const QString &url, Signal signal, bool on);

    /// Of each line: open, the reason when it is not, bytes_out.
    QJsonObject toJson() const;
    QStringList closed() const;

private:
    struct Sending {
        qint64 last;  // count of the bytes written to the line with its last one
        double limit; // monotonic
        Done done;
    };
    struct Line {
        std::unique_ptr<SerialInterface> port;
        QSet<int> signalsLow;
        QString failure;
        std::deque<Sending> sending;
    };

    void open(const QString &url, const QSet<int> &signalsLow);
    void progress(Line &line);
    static void failAll(Line &line, const QString &reason);

    std::map<QString, Line> lines_;
};

} // namespace hermes::softwaretrigger
