#include "gui/desktop/EndSignals.h"

#include <QSocketNotifier>
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <memory>
#include <unistd.h>

namespace hermes::desktop {
namespace {

constexpr int signals[] = {SIGTERM, SIGINT, SIGHUP};
volatile std::sig_atomic_t writeEnd = -1;
int readEnd = -1;
std::unique_ptr<QSocketNotifier> notifier;

void tell(int) {
    const int before = errno;
    [[maybe_unused]] const ssize_t written = ::write(writeEnd, "", 1);
    errno = before;
}

} // namespace

EndSignals::EndSignals() {
    int ends[2] = {-1, -1};
    if (::pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
        return; // they end the program at once, then
    readEnd = ends[0];
    writeEnd = ends[1];
    notifier = std::make_unique<QSocketNotifier>(readEnd, QSocketNotifier::Read);
    connect(notifier.get(), &QSocketNotifier::activated, this, [this] {
        notifier->setEnabled(false);
        Q_EMIT endWanted();
    });
    for (const int signal : signals)
        if (std::signal(signal, tell) == SIG_IGN) // by who has started it (nohup)
            std::signal(signal, SIG_IGN);
}

EndSignals::~EndSignals() {
    if (!notifier)
        return;
    for (const int signal : signals)
        std::signal(signal, SIG_DFL); // who is impatient need not wait for a disk
    notifier.reset();
    ::close(readEnd);
    ::close(writeEnd);
}

} // namespace hermes::desktop
