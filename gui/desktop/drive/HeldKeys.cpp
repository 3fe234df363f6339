#include "gui/desktop/drive/HeldKeys.h"

#include <QGuiApplication>
#include <QLibrary>
#include <QtEndian>
#include <cstdlib>
#include <memory>
#include <utility>

namespace hermes::desktop {
namespace {

// Of xproto.h: the places of what is read in replies and events, in bytes.
constexpr int keysAt = 8, stateAt = 24, sequenceAt = 32;
constexpr int mappingNotify = 34, ofType = 0x7f;

struct Cookie {
    unsigned sequence;
};

/// Null or zero: it is not there.
template <typename Result, typename... Values>
Result xcb(const char *name, Values... values) {
    const QFunctionPointer function = QLibrary::resolve("xcb", 1, name);
    return function ? reinterpret_cast<Result (*)(Values...)>(function)(values...) : Result();
}

using Received = std::unique_ptr<quint8, decltype(&std::free)>;

/// Null: it has not come, or an error has.
Received received(void *connection, unsigned question) {
    void *reply = nullptr, *error = nullptr;
    xcb<int>("xcb_poll_for_reply", connection, question, &reply, &error);
    std::free(error);
    return {static_cast<quint8 *>(reply), &std::free};
}

} // namespace

HeldKeys::HeldKeys()
    : isX_(QGuiApplication::platformName() == "xcb") {
    if (isX_) // it may fail: then nothing is answered
        connection_ = xcb<void *>("xcb_connect", static_cast<char *>(nullptr), static_cast<int *>(nullptr));
}

HeldKeys::~HeldKeys() {
    xcb<void>("xcb_disconnect", connection_); // null is fine
}

void HeldKeys::begin() {
    for (const unsigned question : {keys_, pointer_})
        if (keys_) // it is not answered as yet
            xcb<void>("xcb_discard_reply", connection_, question);
    keys_ = first_ = 0;
    group_ = -1;
    isLayoutChanged_ = false;
    down_.reset();
}

bool HeldKeys::ask(const QWidget &window) {
    if (!connection_)
        return false;
    const bool isAnswered = keys_ && takeAnswer();
    if (!keys_) {
        keys_ = xcb<Cookie>("xcb_query_keymap", connection_).sequence;
        pointer_ = xcb<Cookie>("xcb_query_pointer", connection_, quint32(window.effectiveWinId())).sequence;
        first_ = first_ ? first_ : keys_;
        xcb<int>("xcb_flush", connection_);
    }
    return isAnswered;
}

// The answers come in the order of the questions, and events at their places among them.
bool HeldKeys::takeAnswer() {
    const Received pointer = received(connection_, pointer_);
    if (!pointer)
        return false;
    const Received keymap = received(connection_, std::exchange(keys_, 0));
    for (std::size_t i = 0; keymap && i < down_.size(); ++i)
        down_[i] = keymap.get()[keysAt + i / 8] >> i % 8 & 1;
    const int group = qFromUnaligned<quint16>(pointer.get() + stateAt) >> 13 & 3;
    group_ = group_ < 0 ? group : group_;
    isLayoutChanged_ = isLayoutChanged_ || group != group_;
    while (const Received event{xcb<quint8 *>("xcb_poll_for_event", connection_), &std::free})
        if ((*event & ofType) == mappingNotify && qFromUnaligned<quint32>(event.get() + sequenceAt) >= first_)
            isLayoutChanged_ = true;
    return keymap != nullptr;
}

} // namespace hermes::desktop
