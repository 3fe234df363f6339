#include "gui/hermesctl/KeyTerminal.h"

#include <QWinEventNotifier>
#include <array>
#include <windows.h>

namespace hermes::ctl {
namespace {

HANDLE input() {
    return ::GetStdHandle(STD_INPUT_HANDLE);
}

/// Whether a key was pressed that gives a character. Other events, for which reading would wait, are thrown
/// away: Shift, Ctrl, Alt and dead keys alone, keys that go up, the mouse.
bool hasKey() {
    INPUT_RECORD event{};
    DWORD count = 0;
    while (::PeekConsoleInputW(input(), &event, 1, &count) && count > 0) {
        const KEY_EVENT_RECORD &key = event.Event.KeyEvent;
        if (event.EventType == KEY_EVENT && key.bKeyDown && key.uChar.UnicodeChar != 0)
            return true;
        ::ReadConsoleInputW(input(), &event, 1, &count);
    }
    return false;
}

QByteArray typed() {
    std::array<char, 256> bytes{};
    DWORD count = 0;
    return ::ReadFile(input(), bytes.data(), DWORD(bytes.size()), &count, nullptr)
               ? QByteArray(bytes.data(), int(count))
               : QByteArray();
}

} // namespace

struct KeyTerminal::State {
    DWORD mode = 0;
    bool isTerminal = false;
    QWinEventNotifier notifier{input()};
};

KeyTerminal::KeyTerminal(const std::function<void(const QByteArray &)> &take)
    : state_(std::make_unique<State>()) {
    state_->isTerminal = ::GetConsoleMode(input(), &state_->mode) != 0;
    if (state_->isTerminal)
        ::SetConsoleMode(input(), ENABLE_PROCESSED_INPUT | ENABLE_VIRTUAL_TERMINAL_INPUT);
    forget();
    QObject::connect(&state_->notifier, &QWinEventNotifier::activated, [this, take] {
        if (!state_->isTerminal || hasKey())
            take(typed());
    });
}

KeyTerminal::~KeyTerminal() {
    if (state_->isTerminal)
        ::SetConsoleMode(input(), state_->mode);
}

void KeyTerminal::forget() {
    ::FlushConsoleInputBuffer(input());
}

void KeyTerminal::end() {
    state_->notifier.setEnabled(false);
}

} // namespace hermes::ctl
