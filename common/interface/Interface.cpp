#include "common/interface/Interface.h"

#include "common/Time.h"

#include <algorithm>
#include <chrono>

namespace hermes {
namespace {

constexpr std::chrono::milliseconds firstRetry{100};
constexpr std::chrono::milliseconds usualLongestRetry{5000};

} // namespace

Interface::Interface(QObject *parent)
    : QObject(parent)
    , nextRetry_(firstRetry)
    , longestRetry_(usualLongestRetry) {
    retry_.setSingleShot(true);
    connect(&retry_, &QTimer::timeout, this, &Interface::open);
}

double Interface::unreadSince() const {
    return bootNow();
}

void Interface::open() {
    retry_.stop();
    if (current_ != State::Closed)
        return;
    current_ = State::Opening;
    doOpen();
}

void Interface::setLongestRetry(std::chrono::milliseconds pause) {
    longestRetry_ = pause;
    nextRetry_ = std::min(nextRetry_, pause);
}

void Interface::close(const QString &reason) {
    retry_.stop();
    if (current_ == State::Closed)
        return;
    current_ = State::Closed;
    doClose();
    Q_EMIT closed(reason);
}

bool Interface::write(const QByteArray &bytes) {
    if (!isOpen() || bytesToWrite() + bytes.size() > writeLimit_ || !doWrite(bytes)) {
        counts_.refusedBytes += quint64(bytes.size());
        return false;
    }
    counts_.bytesOut += quint64(bytes.size());
    return true;
}

void Interface::nowOpen() {
    if (current_ != State::Opening)
        return;
    current_ = State::Open;
    ++counts_.opened;
    nextRetry_ = std::min(firstRetry, longestRetry_);
    Q_EMIT opened();
}

void Interface::nowClosed(const QString &reason, bool isError) {
    if (current_ == State::Closed)
        return;
    current_ = State::Closed;
    counts_.errors += isError;
    if (reconnecting_) {
        retry_.start(nextRetry_);
        nextRetry_ = std::min(nextRetry_ * 2, longestRetry_);
    }
    Q_EMIT closed(reason);
}

void Interface::nowReceived(const QByteArray &bytes) {
    counts_.bytesIn += quint64(bytes.size());
    Q_EMIT received(bytes);
}

} // namespace hermes
