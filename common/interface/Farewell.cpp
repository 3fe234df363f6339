#include "common/interface/Farewell.h"

#include <array>
#include <chrono>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hermes {
namespace {

constexpr std::chrono::seconds longest{1};
constexpr std::size_t drainAtOnceBytes = 64 << 10;
constexpr int most = 32; // at the same time

int number = 0; // now; all are in the main thread

} // namespace

void Farewell::say(int socket, QObject *parent) {
    if (number >= most)
        return;
    const int own = ::fcntl(socket, F_DUPFD_CLOEXEC, 0);
    if (own < 0)
        return;
    ::shutdown(own, SHUT_WR);
    new Farewell(own, parent);
}

Farewell::Farewell(int own, QObject *parent)
    : QObject(parent)
    , descriptor_(own)
    , notifier_(own, QSocketNotifier::Read) {
    ++number;
    connect(&notifier_, &QSocketNotifier::activated, this, &Farewell::drain);
    connect(&limit_, &QTimer::timeout, this, &QObject::deleteLater);
    limit_.setSingleShot(true);
    limit_.start(longest);
}

Farewell::~Farewell() {
    --number;
    notifier_.setEnabled(false);
    ::close(descriptor_);
}

void Farewell::drain() {
    static std::array<char, drainAtOnceBytes> nowhere;
    if (::recv(descriptor_, nowhere.data(), nowhere.size(), MSG_DONTWAIT) > 0)
        return;
    notifier_.setEnabled(false);
    deleteLater();
}

} // namespace hermes
