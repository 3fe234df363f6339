#include "common/interface/Interface.h"

#include <algorithm>
#include <chrono>

namespace hermes {
namespace {

constexpr std::chrono::milliseconds firstRetry{100};
constexpr std::chrono::milliseconds usualLongestRetry{5000};

} // namespace

Interface::Interface(QObject *parent)
    : QObject(parent)
    , nextRetry(firstRetry)
    , longestRetry(usualLongestRetry) {
    retry.setSingleShot(true);
    connect(&retry, &QTimer::timeout, this, &Interface::open);
}

void Interface::open() {
    retry.stop();
    if (current != State::Closed)
        return;
    current = State::Opening;
    doOpen();
}

void Interface::setLongestRetry(std::chrono::milliseconds pause) {
    longestRetry = pause;
    nextRetry = std::min(nextRetry, pause);
}

void Interface::close(const QString &reason) {
    retry.stop();
    if (current == State::Closed)
        return;
    current = State::Closed;
    doClose();
    Q_EMIT closed(reason);
}

bool Interface::write(const QByteArray &bytes) {
    if (!isOpen() || bytesToWrite() + bytes.size() > writeLimit || !doWrite(bytes)) {
        counts.refusedBytes += quint64(bytes.size());
        return false;
    }
    counts.bytesOut += quint64(bytes.size());
    return true;
}

void Interface::nowOpen() {
    if (current != State::Opening)
        return;
    current = State::Open;
    ++counts.opened;
    nextRetry = std::min(firstRetry, longestRetry);
    Q_EMIT opened();
}

void Interface::nowClosed(const QString &reason, bool isError) {
    if (current == State::Closed)
        return;
    current = State::Closed;
    counts.errors += isError;
    if (reconnecting) {
        retry.start(nextRetry);
        nextRetry = std::min(nextRetry * 2, longestRetry);
    }
    Q_EMIT closed(reason);
}

void Interface::nowReceived(const QByteArray &bytes) {
    counts.bytesIn += quint64(bytes.size());
    Q_EMIT received(bytes);
}

} // namespace hermes
