#include "gui/desktop/EndSignals.h"

#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <unistd.h>

namespace hermes::desktop {
namespace {

constexpr int signals[] = {SIGTERM, SIGINT, SIGHUP};
volatile std::sig_atomic_t writeEnd = -1;

void tell(int) {
    const int before = errno;
    [[maybe_unused]] const ssize_t written = ::write(writeEnd, "", 1);
    errno = before;
}

} // namespace

EndSignals::EndSignals() {
    if (::pipe2(ends_, O_CLOEXEC | O_NONBLOCK) != 0)
        return; // they end the program at once, then
    writeEnd = ends_[1];
    notifier_ = new QSocketNotifier(ends_[0], QSocketNotifier::Read, this);
    connect(notifier_, &QSocketNotifier::activated, this, [this] {
        notifier_->setEnabled(false);
        Q_EMIT endWanted();
    });
    for (const int signal : signals)
        if (std::signal(signal, tell) == SIG_IGN) // by who has started it (nohup)
            std::signal(signal, SIG_IGN);
}

EndSignals::~EndSignals() {
    if (!notifier_)
        return;
    for (const int signal : signals)
        std::signal(signal, SIG_DFL); // who is impatient need not wait for a disk
    delete notifier_;
    ::close(ends_[0]);
    ::close(ends_[1]);
}

} // namespace hermes::desktop
