#include "common/daemon/SignalWatcher.h"

#include <QSocketNotifier>
#include <csignal>
#include <fcntl.h>
#include <unistd.h>

namespace hermes {
namespace {

constexpr int ends[] = {SIGINT, SIGTERM, SIGHUP}; // SIGHUP: its terminal was closed

int pipeEnds[2] = {-1, -1}; // a handler may only write() to it

pid_t owner = 0;

void handle(int number) {
    if (::getpid() != owner) { // a child between fork() and exec(): the signal is for it alone
        std::signal(number, SIG_DFL);
        ::raise(number);
        return;
    }
    const char byte = char(number);
    if (::write(pipeEnds[1], &byte, 1) < 0) {
        // The pipe is full of the same news.
    }
}

} // namespace

SignalWatcher::SignalWatcher(QObject *parent)
    : QObject(parent) {
    if (::pipe2(pipeEnds, O_CLOEXEC | O_NONBLOCK) != 0)
        qFatal("cannot make a pipe for signals");
    auto *notifier = new QSocketNotifier(pipeEnds[0], QSocketNotifier::Read, this);
    connect(notifier, &QSocketNotifier::activated, this, [this] {
        char byte = 0;
        if (::read(pipeEnds[0], &byte, 1) == 1)
            Q_EMIT received(byte == SIGINT ? "SIGINT" : byte == SIGHUP ? "SIGHUP" : "SIGTERM");
    });
    owner = ::getpid();
    for (const int number : ends)
        std::signal(number, handle);
    std::signal(SIGPIPE, SIG_IGN);
}

SignalWatcher::~SignalWatcher() {
    for (const int number : ends)
        std::signal(number, SIG_DFL);
    ::close(pipeEnds[0]);
    ::close(pipeEnds[1]);
}

} // namespace hermes
