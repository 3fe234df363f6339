#pragma once

#include <QWidget>
#include <bitset>

namespace hermes::desktop {

/// Asks the display which keys are down, where that is possible: an X server, over a connection of its own,
/// without ever waiting for it. Elsewhere only the events of the window tell.
class HeldKeys {
public:
    HeldKeys();
    ~HeldKeys();
    Q_DISABLE_COPY(HeldKeys)

    /// The display is to be asked. When it does not answer, nothing is down.
    bool canAsk() const { return isX_; }
    /// From now on keys are held.
    void begin();
    /// Takes the answer to the last question and asks again. False: none has come.
    bool ask(const QWidget &window);
    /// In the last answer.
    bool isDown(quint32 scanCode) const { return scanCode < down_.size() && down_[scanCode]; }
    /// Since begin(), keys mean something else.
    bool isLayoutChanged() const { return isLayoutChanged_; }

private:
    bool takeAnswer();

    bool isX_;
    void *connection_ = nullptr;
    unsigned keys_ = 0, pointer_ = 0, first_ = 0; ///< numbers of questions; 0: none is open
    int group_ = -1;                              ///< in the first answer
    bool isLayoutChanged_ = false;
    std::bitset<256> down_;
};

} // namespace hermes::desktop
