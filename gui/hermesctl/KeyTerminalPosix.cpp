#include "gui/hermesctl/KeyTerminal.h"

#include <QSocketNotifier>
#include <array>
#include <termios.h>
#include <unistd.h>

namespace hermes::ctl {
namespace {

QByteArray typed() {
    std::array<char, 256> bytes{};
    const auto count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    return count > 0 ? QByteArray(bytes.data(), int(count)) : QByteArray();
}

} // namespace

struct KeyTerminal::State {
    termios settings{};
    bool isTerminal = false;
    QSocketNotifier notifier{STDIN_FILENO, QSocketNotifier::Read};
};

KeyTerminal::KeyTerminal(const std::function<void(const QByteArray &)> &take)
    : state_(std::make_unique<State>()) {
    QObject::connect(&state_->notifier, &QSocketNotifier::activated, [take] { take(typed()); });
    state_->isTerminal = ::tcgetattr(STDIN_FILENO, &state_->settings) == 0;
    if (!state_->isTerminal)
        return;
    termios keys = state_->settings;
    keys.c_lflag &= ~tcflag_t(ICANON | ECHO);
    keys.c_cc[VSUSP] = keys.c_cc[VQUIT] = _POSIX_VDISABLE;
    keys.c_cc[VMIN] = 1;
    keys.c_cc[VTIME] = 0;
    ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &keys);
}

KeyTerminal::~KeyTerminal() {
    if (state_->isTerminal)
        ::tcsetattr(STDIN_FILENO, TCSAFLUSH, &state_->settings);
}

void KeyTerminal::forget() {
    ::tcflush(STDIN_FILENO, TCIFLUSH);
}

void KeyTerminal::end() {
    state_->notifier.setEnabled(false);
}

} // namespace hermes::ctl
