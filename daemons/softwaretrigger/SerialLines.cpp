#include "daemons/softwaretrigger/SerialLines.h"

#include "common/Time.h"

#include <QTimer>

namespace hermes::softwaretrigger {
namespace {

constexpr std::chrono::milliseconds sendLimit{2000};
constexpr qint64 writeLimit = 64 << 10; // bytes that may wait

} // namespace

void SerialLines::use(const Wanted &wanted) {
    for (auto line = lines_.begin(); line != lines_.end();) {
        const auto found = wanted.find(line->first);
        if (found != wanted.end() && found->second == line->second.signalsLow) {
            ++line;
            continue;
        }
        line->second.port->disconnect(this);
        line->second.port->close();
        failAll(line->second, "the line was closed");
        line = lines_.erase(line);
    }
    for (const auto &[url, signalsLow] : wanted) {
        if (lines_.count(url) == 0)
            open(url, signalsLow);
    }
}

void SerialLines::open(const QString &url, const QSet<int> &signalsLow) {
    const auto address = InterfaceUrl::parse(url);
    if (!address)
        return; // checkTriggers lets none pass
    Line &line = lines_[url];
    line.signalsLow = signalsLow;
    line.port = std::make_unique<SerialInterface>(*address, nullptr);
    line.port->setWriteLimit(writeLimit);
    line.port->setReconnecting(true);
    connect(line.port.get(), &Interface::opened, this, [this, &line] {
        line.failure.clear();
        for (const int signal : qAsConst(line.signalsLow)) {
            const auto low = line.port->setSignal(Signal(signal), false);
            if (!low)
                line.failure = low.error().message;
        }
    });
    connect(line.port.get(), &Interface::closed, this, [&line](const QString &reason) {
        line.failure = reason;
        failAll(line, reason);
    });
    connect(line.port.get(), &Interface::drained, this, [this, &line] { progress(line); });
    line.port->open();
}

void SerialLines::send(const QString &url, const QByteArray &bytes, const Done &done) {
    const auto found = lines_.find(url);
    if (found == lines_.end() || !found->second.port->isOpen())
        return done(Error(ErrorCode::DeviceFault,
                          found == lines_.end() ? url + " is no longer a line" : found->second.failure));
    Line &line = found->second;
    if (!line.port->write(bytes))
        return done(
            Error(ErrorCode::OverLimit, QString("%1: %2 bytes wait already, none of %3 more was taken")
                                            .arg(url)
                                            .arg(line.port->bytesToWrite())
                                            .arg(bytes.size())));
    const qint64 last = qint64(line.port->counters().bytesOut);
    line.sending.push_back({last, monotonicNow() + double(sendLimit.count()) / 1000, done});
    QTimer::singleShot(sendLimit, line.port.get(), [this, &line] { progress(line); });
    line.port->flush();
    progress(line);
}

Result<void> SerialLines::set(const QString &url, Signal signal, bool on) {
    const auto found = lines_.find(url);
    if (found == lines_.end())
        return Error(ErrorCode::NotReady, url + " is no longer a line");
    return found->second.port->setSignal(signal, on);
}

void SerialLines::progress(Line &line) {
    const qint64 waits = line.port->bytesToWrite(), gone = qint64(line.port->counters().bytesOut) - waits;
    while (!line.sending.empty()) {
        const Sending first = line.sending.front();
        const bool sent = first.last <= gone;
        if (!sent && monotonicNow() < first.limit)
            return;
        line.sending.pop_front();
        first.done(
            sent ? Result<QJsonValue>(QJsonValue())
                 : Error(ErrorCode::TimedOut,
                         QString("%1: %2 bytes still wait to be sent").arg(line.port->name()).arg(waits)));
    }
}

void SerialLines::failAll(Line &line, const QString &reason) {
    while (!line.sending.empty()) {
        const Sending first = line.sending.front();
        line.sending.pop_front();
        first.done(Error(ErrorCode::DeviceFault, reason));
    }
}

QJsonObject SerialLines::toJson() const {
    QJsonObject result;
    for (const auto &[url, line] : lines_)
        result.insert(url, QJsonObject{{"open", line.port->isOpen()},
                                       {"error", line.failure},
                                       {"bytes_out", double(line.port->counters().bytesOut)}});
    return result;
}

QStringList SerialLines::closed() const {
    QStringList result;
    for (const auto &[url, line] : lines_) {
        if (!line.port->isOpen())
            result.append(url);
    }
    return result;
}

} // namespace hermes::softwaretrigger
