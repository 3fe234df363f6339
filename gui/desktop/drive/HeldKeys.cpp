#include "gui/desktop/drive/HeldKeys.h"

#include <QGuiApplication>
#include <QLibrary>
#include <cstdlib>
#include <memory>
#include <utility>

namespace hermes::desktop {
namespace {

/// What is used of libxcb (xcb.h, xproto.h). Where Qt shows windows by it, it is there.
struct Xcb {
    struct Cookie {
        unsigned sequence;
    };
    struct Keymap {
        quint32 head[2];
        quint8 keys[32];
    };
    struct Pointer {
        quint32 head[4];
        qint16 places[4];
        quint16 state;
    };
    struct Event {
        quint8 type, detail;
        quint16 shortSequence;
        quint32 rest[7], sequence;
    };
    static constexpr quint8 mappingNotify = 34;

    template <typename Function>
    static Function *find(const char *name) {
        return reinterpret_cast<Function *>(QLibrary::resolve("xcb", 1, name));
    }

    void *(*connect)(const char *, int *) = find<void *(const char *, int *)>("xcb_connect");
    void (*disconnect)(void *) = find<void(void *)>("xcb_disconnect");
    int (*flush)(void *) = find<int(void *)>("xcb_flush");
    Cookie (*queryKeymap)(void *) = find<Cookie(void *)>("xcb_query_keymap");
    Cookie (*queryPointer)(void *, quint32) = find<Cookie(void *, quint32)>("xcb_query_pointer");
    int (*poll)(void *, unsigned, void **,
                void **) = find<int(void *, unsigned, void **, void **)>("xcb_poll_for_reply");
    void (*discard)(void *, unsigned) = find<void(void *, unsigned)>("xcb_discard_reply");
    void *(*event)(void *) = find<void *(void *)>("xcb_poll_for_event");
    bool isWhole = connect && disconnect && flush && queryKeymap && queryPointer && poll && discard && event;
};

const Xcb &xcb() {
    static const Xcb functions;
    return functions;
}

template <typename Reply>
using Received = std::unique_ptr<Reply, decltype(&std::free)>;

/// Null: it has not come, or an error has.
template <typename Reply>
Received<Reply> received(void *connection, unsigned question) {
    void *reply = nullptr, *error = nullptr;
    xcb().poll(connection, question, &reply, &error);
    std::free(error);
    return {static_cast<Reply *>(reply), &std::free};
}

} // namespace

HeldKeys::HeldKeys()
    : isX_(QGuiApplication::platformName() == "xcb") {
    if (isX_ && xcb().isWhole)
        connection_ = xcb().connect(nullptr, nullptr); // it may have failed: then nothing is answered
}

HeldKeys::~HeldKeys() {
    if (connection_)
        xcb().disconnect(connection_);
}

void HeldKeys::begin() {
    for (unsigned *const question : {&keys_, &pointer_})
        if (const unsigned old = std::exchange(*question, 0))
            xcb().discard(connection_, old);
    first_ = 0;
    group_ = -1;
    isLayoutChanged_ = false;
    down_.reset();
}

bool HeldKeys::ask(const QWidget &window) {
    if (!connection_)
        return false;
    const bool isAnswered = keys_ && takeAnswer();
    if (!keys_ && !pointer_) {
        keys_ = xcb().queryKeymap(connection_).sequence;
        pointer_ = xcb().queryPointer(connection_, quint32(window.effectiveWinId())).sequence;
        first_ = first_ ? first_ : keys_;
        xcb().flush(connection_);
    }
    return isAnswered;
}

// The answers come in the order of the questions, and events at their places among them.
bool HeldKeys::takeAnswer() {
    const auto pointer = received<Xcb::Pointer>(connection_, pointer_);
    if (!pointer)
        return false;
    const auto keymap = received<Xcb::Keymap>(connection_, keys_);
    keys_ = pointer_ = 0;
    if (!keymap)
        return false;
    for (std::size_t i = 0; i < down_.size(); ++i)
        down_[i] = keymap->keys[i / 8] >> i % 8 & 1;
    const int group = pointer->state >> 13 & 3;
    group_ = group_ < 0 ? group : group_;
    isLayoutChanged_ = isLayoutChanged_ || group != group_;
    while (const Received<Xcb::Event> event{static_cast<Xcb::Event *>(xcb().event(connection_)), &std::free})
        isLayoutChanged_ =
            isLayoutChanged_ || ((event->type & 0x7f) == Xcb::mappingNotify && event->sequence >= first_);
    return true;
}

} // namespace hermes::desktop
